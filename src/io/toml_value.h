#pragma once
// A TOML document with the place of each value, as JsonValue has it for JSON: every complaint names its key.

#include <toml++/toml.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace goniofit {

/// Throws Error (bad_input): syntax errors as "FILE:LINE: column C: ...".
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& source);

/// One value of a document and where it stands. Cheap to copy; the document must outlive it.
class TomlValue {
 public:
  TomlValue(const toml::node& node, const std::string& source, std::string pointer = {})
      : node_(&node), source_(&source), pointer_(std::move(pointer)) {}

  [[nodiscard]] const std::string& source() const { return *source_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] bool is_number() const { return node_->is_number(); }
  [[nodiscard]] bool is_string() const { return node_->is_string(); }
  [[nodiscard]] bool is_array() const { return node_->is_array(); }
  [[nodiscard]] bool is_table() const { return node_->is_table(); }

  // Each of these throws Error (bad_input) where the value is of another type; `expected` is for the message.
  [[nodiscard]] double number(const std::string& expected = "a number") const;  ///< finite
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::int64_t whole_number(const std::string& expected) const;
  [[nodiscard]] const std::string& text(const std::string& expected = "a string") const;
  void for_each_element(const std::string& expected, const std::function<void(const TomlValue&)>& visit) const;
  void for_each_member(const std::string& expected,
                       const std::function<void(const std::string&, const TomlValue&)>& visit) const;

  /// The member of a table; nullopt where it is absent.
  [[nodiscard]] std::optional<TomlValue> find(std::string_view key) const;
  /// Error where the value is no table or has a key that is none of these.
  void expect_keys(std::initializer_list<std::string_view> keys) const;

  /// Throws Error (bad_input) about this value.
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_type(const std::string& expected) const;
  /// Error "is VALUE, expected EXPECTED" unless `holds`.
  void require(bool holds, double value, const std::string& expected) const;

 private:
  const toml::node* node_;
  const std::string* source_;
  std::string pointer_;
};

}  // namespace goniofit
