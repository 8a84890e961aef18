#pragma once
// Blinn-Phong (Blinn 1977, as normalised in Ngan, Durand & Matusik 2005): f = k_d/pi + k_s (n+2)/(2 pi) (N·H)^n.
//
// (n+2)/(2 pi) normalises the facet distribution, not the reflection: towards large n the lobe with k_s = 1 reflects
// 4 cos² theta_i, so k_s has no upper bound.

#include <memory>

#include "lobes.h"

namespace goniofit {

/// (n+2)/(2 pi) cos^n theta_b, n = e^z; cos^n as exp(-n/2 ln(1 + tan²)), exact at the mirror where 1 - cos is lost.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T blinn_phong_lobe(const T& z, const BasicPair<G>& p) {
  using namespace math;
  const T n = exp(z);
  return (n + 2.0) / (2.0 * pi_of<G>()) * exp(-0.5 * n * log1p(p.tan2_b));
}

struct BlinnPhong {
  static constexpr std::size_t columns = 2, parameters = 1;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    values[1] = blinn_phong_lobe(z[0], p);
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_blinn_phong();

}  // namespace goniofit
