#include "io/json_value.h"

#include <algorithm>
#include <set>

#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

using Json = nlohmann::json;

// Watches the parser: how deep it is, where it is, which keys an object has had. The parser itself keeps the last of
// two equal keys without a word.
class ParseWatch {
 public:
  ParseWatch(const std::string& source, int deepest) : source_(source), deepest_(deepest) {}

  bool operator()(int /*depth*/, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        next_element();
        levels_.push_back({event == Event::array_start, 0, {}, {}});
        if (levels_.size() > static_cast<std::size_t>(deepest_)) {
          throw key_error(source_, pointer(),
                          "is nested too deeply, expected at most " + std::to_string(deepest_) + " levels");
        }
        break;
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        break;
      case Event::key:
        levels_.back().key = parsed.get_ref<const std::string&>();
        if (!levels_.back().keys.insert(levels_.back().key).second) {
          throw key_error(source_, pointer(), "is given twice, expected each key once");
        }
        break;
      case Event::value:
        next_element();
        break;
    }
    return true;
  }

  // Of the innermost value that has begun.
  [[nodiscard]] std::string pointer() const {
    std::string out;
    for (const Level& level : levels_) {
      if (level.is_array && level.elements > 0) out += pointer_step(std::to_string(level.elements - 1));
      if (!level.is_array && !level.keys.empty()) out += pointer_step(level.key);
    }
    return out;
  }

  // Of the value that the parser stumbled over before it reported it.
  [[nodiscard]] std::string next_pointer() {
    next_element();
    return pointer();
  }

 private:
  struct Level {
    bool is_array;
    std::size_t elements;
    std::string key;
    std::set<std::string> keys;
  };
  void next_element() {
    if (!levels_.empty() && levels_.back().is_array) ++levels_.back().elements;
  }

  const std::string& source_;
  int deepest_;
  std::vector<Level> levels_;
};

// "[json.exception.parse_error.101] parse error at line 1, column 2: what" without what comes before the last part.
std::string cause(const std::string& message) {
  constexpr std::string_view mark = ": ";
  const std::size_t at = message.find(mark);
  std::string text = at == std::string::npos ? message : message.substr(at + mark.size());
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  constexpr std::size_t longest = 200;
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

[[noreturn]] void throw_syntax_error(std::string_view text, const std::string& source, const Json::parse_error& error) {
  const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
  const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
  throw input_error(source, line, std::to_string(before.size() - line_start + 1), cause(error.what()));
}

}  // namespace

Json parse_json(std::string_view text, const std::string& source, int deepest) {
  ParseWatch watch(source, deepest);
  try {
    return Json::parse(text, std::ref(watch));
  } catch (const Json::parse_error& error) {
    throw_syntax_error(text, source, error);
  } catch (const Json::out_of_range&) {
    throw key_error(source, watch.next_pointer(), "is a number beyond 1.8e308, expected a smaller one");
  }
}

void JsonValue::fail(const std::string& what) const { throw key_error(*source_, pointer_, what); }

void JsonValue::fail_type(const std::string& expected) const {
  const std::string type = value_->type_name();
  const std::string article = type == "null" ? "" : type == "object" || type == "array" ? "an " : "a ";
  fail("is " + article + type + ", expected " + expected);
}

double JsonValue::number() const {
  if (!value_->is_number()) fail_type("a number");
  return value_->get<double>();
}

std::optional<double> JsonValue::number_or_null() const {
  if (value_->is_null()) return std::nullopt;
  if (!value_->is_number()) fail_type("a number or null");
  return value_->get<double>();
}

std::size_t JsonValue::count() const {
  if (!value_->is_number()) fail_type("a whole number");
  if (!value_->is_number_unsigned())
    fail("is " + in_quotes(value_->dump()) + ", expected a whole number of at least 0");
  return value_->get<std::size_t>();
}

bool JsonValue::boolean() const {
  if (!value_->is_boolean()) fail_type("true or false");
  return value_->get<bool>();
}

const std::string& JsonValue::text() const {
  if (!value_->is_string()) fail_type("a string");
  return value_->get_ref<const std::string&>();
}

void JsonValue::for_each_element(const std::function<void(const JsonValue&)>& visit) const {
  if (!value_->is_array()) fail_type("an array");
  std::size_t index = 0;
  for (const Json& element : *value_) visit({element, *source_, pointer_ + pointer_step(std::to_string(index++))});
}

void JsonValue::for_each_member(const std::function<void(const std::string&, const JsonValue&)>& visit) const {
  if (!value_->is_object()) fail_type("an object");
  for (const auto& [key, member] : value_->items()) visit(key, {member, *source_, pointer_ + pointer_step(key)});
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!value_->is_object()) fail_type("an object");
  const auto member = value_->find(std::string(key));
  if (member == value_->end()) return std::nullopt;
  return JsonValue{*member, *source_, pointer_ + pointer_step(key)};
}

JsonValue JsonValue::at(std::string_view key) const {
  if (std::optional<JsonValue> member = find(key)) return *member;
  throw key_error(*source_, pointer_ + pointer_step(key), "is missing");
}

void JsonValue::expect_keys(const std::vector<std::string_view>& keys) const {
  for_each_member([&](const std::string& key, const JsonValue& member) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      member.fail("is not a known key, expected " + alternatives(keys));
    }
  });
}

}  // namespace goniofit
