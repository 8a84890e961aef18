#pragma once
// Names of effects, tiers and forms as files give them, with an answer for those the formats know and this version
// lacks.

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "../brdf/material.h"
#include "../support/error.h"
#include "../support/text.h"

namespace goniofit {

/// Known to the file formats, not available: told apart from a misspelling.
inline constexpr std::array names_without_model{
    std::string_view{"smith"},       std::string_view{"schlick"},   std::string_view{"he"},
    std::string_view{"he-torrance"}, std::string_view{"student-t"}, std::string_view{"he-torrance-series"},
    std::string_view{"rough"},       std::string_view{"integral"},  std::string_view{"qualitative"}};

[[nodiscard]] inline Error unknown_name(const std::string& file, const std::string& pointer, std::string_view name,
                                        const std::string& expected) {
  const bool later =
      std::find(names_without_model.begin(), names_without_model.end(), name) != names_without_model.end();
  return key_error(file, pointer,
                   in_quotes(name) + (later ? " is not available" : " is not known") + ", expected " + expected);
}

/// E is any enumeration of brdf/material.h. Throws Error (bad_input) naming what there is.
template <class E>
[[nodiscard]] E require_name(const std::string& file, const std::string& pointer, std::string_view name) {
  const std::optional<E> value = parse_name<E>(name);
  if (!value) throw unknown_name(file, pointer, name, names_of<E>());
  return *value;
}

}  // namespace goniofit
