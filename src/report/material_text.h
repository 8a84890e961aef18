#pragma once
// A material's settings in words, for reports.

#include <string>

#include "../brdf/material.h"

namespace goniofit {

/// "Fresnel schlick, shadowing li-torrance, ...": what the model reads.
[[nodiscard]] std::string terms_text(const Material& material);
/// The forms that something reads; empty for none.
[[nodiscard]] std::string forms_text(const Material& material);

}  // namespace goniofit
