#pragma once
// The effects as basis columns: value = coefficient * optics factor * shape factor.
//
//   effect  coefficient  optics factor       shape factor
//   coh     k_dd         F(u)                S exp(-g) / (cos_i dOmega) inside the mirror cone
//   dd      k_dd         F(u)                S D / (pi cos_i cos_r)
//   udf     k_udf        1                   1/pi
//   uds     k_uds        T(cos_i) T(cos_r)   1/pi
//   fs      k_fs         T(cos_i) T(cos_r)   (1-cos_i)(1-cos_r) exp(-tan²θ_f/(16 m_e²)) / pi
//
// Only the optics factor reads a channel's n and kappa, only the shape factor reads slope, sigma and the wavelength.
// That is what makes a fit fast: shape factors are shared by channels, optics factors by every point of the search.

#include "../geometry/angles.h"
#include "../geometry/pair.h"
#include "../terms/effective_roughness.h"
#include "../terms/shadowing.h"
#include "../terms/slope_distribution.h"
#include "material.h"

namespace goniofit {

enum class OpticsFactor : std::uint8_t { one, fresnel, transmission };

[[nodiscard]] constexpr OpticsFactor optics_factor_of(Coefficient c) noexcept {
  switch (c) {
    case Coefficient::k_dd:
      return OpticsFactor::fresnel;
    case Coefficient::k_udf:
      return OpticsFactor::one;
    case Coefficient::k_uds:
    case Coefficient::k_fs:
      return OpticsFactor::transmission;
  }
  return OpticsFactor::one;
}

/// What dd, fs and coh share at one pair of directions. T carries the shape parameters, G the geometry.
template <class T>
struct SurfaceTerms {
  T log_m_e;                 ///< ln(sigma_e / tau)
  T shadowing_over_cosines;  ///< S / (cos_i cos_r)
};

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, class T, class G, class Floor = math::NoFloor>
[[nodiscard]] [[gnu::always_inline]] inline SurfaceTerms<T> surface_terms(const T& log_slope, const T& q,
                                                                          const BasicPair<G>& p, Floor floor = {}) {
  return {log_slope + log_effective_roughness<roughness>(q, p, floor), shadowing_over_cosines<shadowing>(q, p, floor)};
}

/// S D / (pi cos_i cos_r).
template <class T, class G, class Floor = math::NoFloor>
[[nodiscard]] [[gnu::always_inline]] inline T dd_shape(const SurfaceTerms<T>& t, const BasicPair<G>& p,
                                                       Floor floor = {}) {
  using namespace math;
  const T lobe = exp(floored(rough_limit_log(t.log_m_e, p), floor));
  return t.shadowing_over_cosines * (slope_independent_factor(p) / pi) * lobe;
}

/// (1-cos_i)(1-cos_r) exp(-tan²θ_f/(16 m_e²)) / pi on the forward side. `printed` has tan²θ_f of V alone and is not
/// reciprocal (up to 86 % of its maximum for the paper's laser paper); `reciprocal` takes the mean of both orders.
template <FsForm form, class T, class G, class Floor = math::NoFloor>
[[nodiscard]] [[gnu::always_inline]] inline T fs_shape(const SurfaceTerms<T>& t, const BasicPair<G>& p,
                                                       Floor floor = {}) {
  using namespace math;
  const G tan2 = form == FsForm::printed ? p.tan2_f : 0.5 * (p.tan2_f + p.tan2_f_swapped);
  const G reach = p.one_minus_cos_i * p.one_minus_cos_r / pi;
  const T lobe = exp(floored(T(-0.0625 * over_m_e2(tan2, t.log_m_e)), floor));
  return lobe * select(p.forward, reach, G(0.0));
}

/// Whether V lies in the cone of solid angle dOmega about the mirror direction: 2(1 - cos) <= dOmega/pi.
template <class G>
[[nodiscard]] inline bool in_mirror_cone(const BasicPair<G>& p, double solid_angle_sr) {
  return p.mirror_distance2 <= solid_angle_sr / pi;
}

/// S exp(-g) / (cos_i dOmega), g = [2 pi sigma_e (cos_i + cos_r) / lambda]², wherever the caller found the cone. The
/// mirror preserves the source's solid angle: LT (3) prints cos_r in its place, LT (16) does not.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T coh_shape(const SurfaceTerms<T>& t, const T& log_slope,
                                                        const T& log_sigma, double wavelength_um, double solid_angle_sr,
                                                        const BasicPair<G>& p) {
  using namespace math;
  const T sigma_e = exp(log_sigma + t.log_m_e - log_slope);
  const T phase = (2.0 * pi / wavelength_um) * p.s_z * sigma_e;
  return t.shadowing_over_cosines * (p.cos_r / solid_angle_sr) * exp(-phase * phase);
}

}  // namespace goniofit
