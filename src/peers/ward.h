#pragma once
// Ward 1992: f = k_d/pi + k_s exp(-(s_x²/alpha_x² + s_y²/alpha_y²)/s_z²) / (4 pi alpha_x alpha_y sqrt(cos_i cos_r)),
// isotropic where alpha_x = alpha_y. The printed form with the square root (not the Ward-Duer one without): it loses
// energy towards grazing. Ward's model has no Fresnel factor.

#include <memory>

#include "lobes.h"

namespace goniofit {

/// z_x = ln alpha_x, z_y = ln alpha_y. Two square roots: the product of two grazing cosines could underflow.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T ward_lobe(const T& z_x, const T& z_y, const BasicPair<G>& p) {
  using namespace math;
  const G s_z2 = p.s_z * p.s_z;
  const T slope2 = p.s_x2 / s_z2 * exp(-2.0 * z_x) + p.s_y2 / s_z2 * exp(-2.0 * z_y);
  return exp(-slope2 - z_x - z_y) / (4.0 * pi_of<G>() * (sqrt(p.cos_i) * sqrt(p.cos_r)));
}

/// The same for alpha_x = alpha_y, by tan² of the facet alone.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T ward_lobe(const T& z, const BasicPair<G>& p) {
  using namespace math;
  return exp(-p.tan2_b * exp(-2.0 * z) - 2.0 * z) / (4.0 * pi_of<G>() * (sqrt(p.cos_i) * sqrt(p.cos_r)));
}

struct Ward {
  static constexpr std::size_t columns = 2, parameters = 1;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    values[1] = ward_lobe(z[0], p);
  }
};

struct WardAnisotropic {
  static constexpr std::size_t columns = 2, parameters = 2;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    values[1] = ward_lobe(z[0], z[1], p);
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_ward();
[[nodiscard]] std::unique_ptr<const Basis> make_ward_anisotropic();

}  // namespace goniofit
