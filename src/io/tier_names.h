#pragma once
// Names of effects, tiers and forms as files give them.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "../basis/basis.h"
#include "../brdf/material.h"
#include "../peers/peers.h"
#include "../support/error.h"
#include "../support/text.h"

namespace goniofit {

[[nodiscard]] inline Error unknown_name(const std::string& file, const std::string& pointer, std::string_view name,
                                        const std::string& expected) {
  return key_error(file, pointer, in_quotes(name) + " is not known, expected " + expected);
}

/// E is any enumeration of brdf/material.h. Throws Error (bad_input) naming what there is.
template <class E>
[[nodiscard]] E require_name(const std::string& file, const std::string& pointer, std::string_view name) {
  const std::optional<E> value = parse_name<E>(name);
  if (!value) throw unknown_name(file, pointer, name, names_of<E>());
  return *value;
}

/// The basis of a peer model, or null for the surface family. Throws Error (bad_input) for a name that is no model.
[[nodiscard]] inline std::unique_ptr<const Basis> require_model(const std::string& file, const std::string& pointer,
                                                                const std::string& name) {
  if (name == surface_model) return nullptr;
  std::unique_ptr<const Basis> basis = make_peer(name);
  if (!basis) {
    throw key_error(file, pointer, in_quotes(name) + " is no model, expected one that `goniofit models` names");
  }
  return basis;
}

}  // namespace goniofit
