#pragma once
// What several peer models are made of. z is always the logarithm of the width, exponent or roughness it is named
// after, as in ShapeParameter.

#include <string>
#include <utility>

#include "../basis/basis.h"
#include "../geometry/pair.h"
#include "../terms/scalar.h"

namespace goniofit {

/// f of a white Lambert surface.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G white_lambert() {
  return 1.0 / math::pi_of<G>();
}

/// Beckmann's D with alpha = e^z, the integral of D cos over the hemisphere being 1: exp(-tan²θ_b/α²)/(π α² cos⁴θ_b).
/// One exponential, so that no factor leaves the range of doubles before the product does.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T beckmann_distribution(const T& z, const BasicPair<G>& p) {
  using namespace math;
  const G sec2 = 1.0 + p.tan2_b;
  return sec2 * sec2 / pi_of<G>() * exp(-2.0 * z - p.tan2_b * exp(-2.0 * z));
}

/// sin² of the two zenith angles, without the cancellation of 1 - cos² near the normal.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G sin2_i(const BasicPair<G>& p) {
  return p.one_minus_cos_i * (1.0 + p.cos_i);
}
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G sin2_r(const BasicPair<G>& p) {
  return p.one_minus_cos_r * (1.0 + p.cos_r);
}

/// Diffuse reflectance of a model that has a Lambert part, and its column.
[[nodiscard]] inline BasisCoefficient diffuse_coefficient() { return {"k_d", 0.0, 1.0}; }
[[nodiscard]] inline BasisColumn diffuse_column() { return {0, OpticsFactor::one, false}; }

/// Width of a facet distribution (Beckmann's alpha and its like): a step of 0.2 in ln alpha moves a lobe's flank by a
/// fifth of its width.
[[nodiscard]] inline ShapeParameter width_parameter(const char* name) { return {name, "", 1e-3, 2.0, 0.0, 0.2}; }

/// The second width of an anisotropic lobe, searched as ratios to the first.
[[nodiscard]] inline ShapeParameter second_width_parameter(const char* name) {
  ShapeParameter width = width_parameter(name);
  width.probes = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
  width.relative_to = 0;
  return width;
}

/// Exponent n of a cosine lobe, whose width is about sqrt(2/n): twice the step of a width.
[[nodiscard]] inline ShapeParameter exponent_parameter(std::string name, double lower, double upper) {
  return {std::move(name), "", lower, upper, 0.0, 0.4};
}

}  // namespace goniofit
