#include "io/toml_value.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/error.h"
#include "support/text.h"

namespace goniofit {

toml::table parse_toml(std::string_view text, const std::string& source) {
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw input_error(source, at.line, std::to_string(at.column), std::string(error.description()));
  }
}

void TomlValue::fail(const std::string& what) const { throw key_error(*source_, pointer_, what); }

void TomlValue::fail_type(const std::string& expected) const {
  std::ostringstream type;
  type << node_->type();
  const std::string name = type.str();
  const bool vowel = name.starts_with("a") || name.starts_with("i");
  fail(std::string(vowel ? "is an " : "is a ") + name + ", expected " + expected);
}

void TomlValue::require(bool holds, double value, const std::string& expected) const {
  if (!holds) fail("is " + shortest(value) + ", expected " + expected);
}

double TomlValue::number(const std::string& expected) const {
  if (!node_->is_number()) fail_type(expected);
  // Not node::value(), which has no answer for integers beyond 2^53.
  const double value = node_->is_integer() ? static_cast<double>(**node_->as_integer()) : **node_->as_floating_point();
  require(std::isfinite(value), value, expected);
  return value;
}

bool TomlValue::boolean() const {
  if (!node_->is_boolean()) fail_type("true or false");
  return **node_->as_boolean();
}

std::int64_t TomlValue::whole_number(const std::string& expected) const {
  if (!node_->is_integer()) fail_type(expected);
  return **node_->as_integer();
}

const std::string& TomlValue::text(const std::string& expected) const {
  if (!node_->is_string()) fail_type(expected);
  return **node_->as_string();
}

void TomlValue::for_each_element(const std::string& expected,
                                 const std::function<void(const TomlValue&)>& visit) const {
  const toml::array* array = node_->as_array();
  if (array == nullptr) fail_type(expected);
  std::size_t index = 0;
  for (const toml::node& element : *array) visit({element, *source_, pointer_ + pointer_step(std::to_string(index++))});
}

void TomlValue::for_each_member(const std::string& expected,
                                const std::function<void(const std::string&, const TomlValue&)>& visit) const {
  const toml::table* table = node_->as_table();
  if (table == nullptr) fail_type(expected);
  for (const auto& [key, member] : *table) {
    visit(std::string(key.str()), {member, *source_, pointer_ + pointer_step(key.str())});
  }
}

std::optional<TomlValue> TomlValue::find(std::string_view key) const {
  const toml::table* table = node_->as_table();
  if (table == nullptr) fail_type("a table");
  const toml::node* member = table->get(key);
  if (member == nullptr) return std::nullopt;
  return TomlValue{*member, *source_, pointer_ + pointer_step(key)};
}

void TomlValue::expect_keys(std::initializer_list<std::string_view> keys) const {
  for_each_member("a table", [&](const std::string& key, const TomlValue& member) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      member.fail("is not a known key, expected " + alternatives(keys));
    }
  });
}

}  // namespace goniofit
