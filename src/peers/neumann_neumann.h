#pragma once
// The metallic lobe of Neumann, Neumann & Szirmay-Kalos 1999 ("Compact metallic reflectance models"): Phong's lobe
// about the mirror direction R of L, divided by the greater cosine, which keeps it reciprocal and as bright at grazing
// as at the normal:
//
//   f = k_d/pi + k_s (n+2)/(2 pi) max(0, R·V)^n / max(cos_i, cos_r).
//
// (n+2)/(2 pi) makes the albedo of the lobe exactly 1 at normal incidence for every n, and by the measure of the tests
// it is nowhere above that for n >= 1.

#include <memory>

#include "lobes.h"

namespace goniofit {

/// n = e^z. R·V = 1 - |V - R|²/2 keeps the digits of narrow lobes.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T neumann_neumann_lobe(const T& z, const BasicPair<G>& p) {
  using namespace math;
  const G half_distance2 = 0.5 * p.mirror_distance2;
  const bool behind = half_distance2 >= 1.0;
  const G cosine_less_1 = select(behind, G(-0.5), G(-half_distance2));
  const T n = exp(z);
  const T lobe =
      (n + 2.0) / (2.0 * pi_of<G>() * select(p.cos_i > p.cos_r, p.cos_i, p.cos_r)) * exp(n * G(log1p(cosine_less_1)));
  return select(behind, T(0.0), lobe);
}

struct NeumannNeumann {
  static constexpr std::size_t columns = 2, parameters = 1;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    values[1] = neumann_neumann_lobe(z[0], p);
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_neumann_neumann();

}  // namespace goniofit
