#pragma once
// The YAML files of refractiveindex.info, as far as they tabulate n and k or give a Sellmeier formula.

#include <string>

#include "optical_constants.h"

namespace goniofit {

/// Blocks `tabulated nk`, `tabulated n`, `formula 1` and `formula 2`; each of n's also with a `tabulated k` beside it,
/// over the wavelengths that both have. A formula is tabulated so densely that interpolating in it errs by less than
/// 1e-6 for glasses. Throws Error (bad_input) with file and line.
[[nodiscard]] OpticalConstants parse_refractive_index_yaml(const std::string& text, const std::string& source);

}  // namespace goniofit
