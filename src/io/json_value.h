#pragma once
// A JSON document with the place of each value, so that every complaint about a value names its JSON pointer.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace goniofit {

/// Throws Error (bad_input): syntax errors with line and column, numbers out of range, duplicated keys and nesting
/// deeper than `deepest` with their pointer.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const std::string& source, int deepest);

/// One value of a document and where it stands. Cheap to copy; the document must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& value, const std::string& source, std::string pointer = {})
      : value_(&value), source_(&source), pointer_(std::move(pointer)) {}

  [[nodiscard]] const std::string& source() const { return *source_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] bool is_null() const { return value_->is_null(); }
  [[nodiscard]] bool is_object() const { return value_->is_object(); }

  // Each of these throws Error (bad_input) where the value is of another type.
  [[nodiscard]] double number() const;
  [[nodiscard]] std::optional<double> number_or_null() const;
  [[nodiscard]] std::size_t count() const;  ///< a whole number of at least 0
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] const std::string& text() const;
  void for_each_element(const std::function<void(const JsonValue&)>& visit) const;
  void for_each_member(const std::function<void(const std::string&, const JsonValue&)>& visit) const;

  /// The member of an object; nullopt where it is absent.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
  /// The member of an object; Error where it is absent.
  [[nodiscard]] JsonValue at(std::string_view key) const;
  /// Error where the object has a key that is none of these.
  void expect_keys(const std::vector<std::string_view>& keys) const;

  /// Throws Error (bad_input) about this value.
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_type(const std::string& expected) const;

 private:
  const nlohmann::json* value_;
  const std::string* source_;
  std::string pointer_;
};

}  // namespace goniofit
