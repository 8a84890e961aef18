#pragma once
// Enumerations and how files and flags spell their values.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "text.h"

namespace goniofit {

template <class E>
struct Named {
  E value;
  std::string_view name;
};

/// Empty for a value that the table does not have.
template <class E>
[[nodiscard]] std::string_view name_in(std::span<const Named<E>> table, E value) noexcept {
  for (const Named<E>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

template <class E>
[[nodiscard]] std::optional<E> value_in(std::span<const Named<E>> table, std::string_view name) noexcept {
  for (const Named<E>& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

/// "schlick, exact or none".
template <class E>
[[nodiscard]] std::string names_in(std::span<const Named<E>> table) {
  std::vector<std::string_view> all;
  for (const Named<E>& entry : table) all.push_back(entry.name);
  return alternatives(all);
}

}  // namespace goniofit
