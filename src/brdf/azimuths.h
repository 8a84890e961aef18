#pragma once
// Whether a material looks different from another azimuth: what samplings and tables must know of it.

#include <cmath>
#include <cstddef>

#include "evaluator.h"

namespace goniofit {

/// A surface by its second slope; a peer by its values, since only its formula knows. They are compared at steps of
/// every width from the mirror direction: a lobe shows its shape where it falls off.
[[nodiscard]] inline bool is_anisotropic(const Evaluator& evaluator) {
  if (evaluator.material().model == surface_model) return evaluator.material().surface.anisotropic();
  constexpr double theta_i = 40.0;
  constexpr double round_off = 1e-6;  // of exponents up to 1e6
  for (double off_mirror = 1e-4; off_mirror < 45.0; off_mirror *= 2.0) {
    const Pair here = make_pair({theta_i, 0.0, theta_i + off_mirror, 180.0});
    for (const double turn : {45.0, 90.0}) {
      const Pair turned = make_pair({theta_i, turn, theta_i + off_mirror, 180.0 + turn});
      for (std::size_t c = 0; c < evaluator.channels(); ++c) {
        const double f = evaluator.value(here, c);
        if (std::fabs(evaluator.value(turned, c) - f) > round_off * f) return true;
      }
    }
  }
  return false;
}

}  // namespace goniofit
