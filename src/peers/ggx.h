#pragma once
// GGX (Walter, Marschner, Li & Torrance 2007) with the height-correlated Smith shadowing of Heitz 2014:
// f = k_d/pi + k_s F D G/(4 cos_i cos_r), G = 1/(1 + Lambda(L) + Lambda(V)).

#include <memory>

#include "lobes.h"

namespace goniofit {

/// D = sec⁴/(pi alpha_x alpha_y (1 + tan²_x/alpha_x² + tan²_y/alpha_y²)²), z = ln alpha.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T ggx_distribution(const T& z_x, const T& z_y, const BasicPair<G>& p) {
  using namespace math;
  const G s_z2 = p.s_z * p.s_z;
  const G sec2 = 1.0 + p.tan2_b;
  const T tail = 1.0 + p.s_x2 / s_z2 * exp(-2.0 * z_x) + p.s_y2 / s_z2 * exp(-2.0 * z_y);
  return sec2 * sec2 / pi_of<G>() * exp(-z_x - z_y) / (tail * tail);
}
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T ggx_distribution(const T& z, const BasicPair<G>& p) {
  using namespace math;
  const G sec2 = 1.0 + p.tan2_b;
  const T tail = 1.0 + p.tan2_b * exp(-2.0 * z);
  return sec2 * sec2 / pi_of<G>() * exp(-2.0 * z) / (tail * tail);
}

/// G/(4 cos_i cos_r) = ½/(cos_r w(L) + cos_i w(V)), w = sqrt(cos² + alpha² sin²) with the alpha of the direction's
/// azimuth: no quotient of vanishing terms at grazing.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T smith_ggx_over_cosines(const T& alpha2_i, const T& alpha2_r,
                                                                     const BasicPair<G>& p) {
  using namespace math;
  const T w_i = sqrt(p.cos_i * p.cos_i + alpha2_i * sin2_i(p));
  const T w_r = sqrt(p.cos_r * p.cos_r + alpha2_r * sin2_r(p));
  return 0.5 / (p.cos_r * w_i + p.cos_i * w_r);
}

struct Ggx {
  static constexpr std::size_t columns = 2, parameters = 1;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    using namespace math;
    const T alpha2 = exp(2.0 * z[0]);
    values[0] = T(white_lambert<G>());
    values[1] = ggx_distribution(z[0], p) * smith_ggx_over_cosines(alpha2, alpha2, p);
  }
};

struct GgxAnisotropic {
  static constexpr std::size_t columns = 2, parameters = 2;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    using namespace math;
    const T x2 = exp(2.0 * z[0]);
    const T y2 = exp(2.0 * z[1]);
    const T alpha2_i = p.cos2_phi_i * x2 + p.sin2_phi_i * y2;
    const T alpha2_r = p.cos2_phi_r * x2 + p.sin2_phi_r * y2;
    values[0] = T(white_lambert<G>());
    values[1] = ggx_distribution(z[0], z[1], p) * smith_ggx_over_cosines(alpha2_i, alpha2_r, p);
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_ggx();
[[nodiscard]] std::unique_ptr<const Basis> make_ggx_anisotropic();

}  // namespace goniofit
