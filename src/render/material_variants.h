#pragma once
// One material by several models, to be looked at side by side.

#include <string>

#include "../brdf/material.h"

namespace goniofit {

/// What variant_of takes, for messages.
inline constexpr const char* variant_words =
    "given, lambert, li-torrance, he-torrance, no-shadowing, no-roughness, neither, or effects such as dd+uds";

/// "given": as it is. "lambert": diffuse, of its reflectance at normal incidence. "li-torrance", "he-torrance": with
/// their terms. "no-shadowing", "no-roughness", "neither": its terms without S, sigma_e or both. Effects joined by +:
/// those alone. Throws Error (bad_input) for another name, for a peer but given and lambert, and where the material
/// lacks what the terms read; validate() has the words.
[[nodiscard]] Material variant_of(const Material& material, const std::string& name);

}  // namespace goniofit
