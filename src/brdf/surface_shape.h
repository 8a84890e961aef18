#pragma once
// The shape factors of the surface family at one pair of directions, for every tier, form and isotropy. Templates on
// the scalar T of the shape parameters and G of the geometry.

#include <cmath>

#include "../geometry/angles.h"
#include "../geometry/pair.h"
#include "../terms/effective_roughness.h"
#include "../terms/he_torrance.h"
#include "../terms/he_torrance_series.h"
#include "../terms/shadowing.h"
#include "../terms/slope_distribution.h"
#include "../terms/student_t_shadowing.h"
#include "../terms/zenith.h"
#include "material.h"

namespace goniofit {

/// Which tiers and forms shape factors are evaluated with.
struct ShapeSettings {
  ShadowingTier shadowing = ShadowingTier::li_torrance;
  EffectiveRoughnessTier effective_roughness = EffectiveRoughnessTier::li_torrance;
  DistributionTier distribution = DistributionTier::rough_limit;
  Forms forms;
  bool anisotropic = false;

  [[nodiscard]] static ShapeSettings of(const Terms& terms, const Forms& forms, bool anisotropic) noexcept {
    return {terms.shadowing, terms.effective_roughness, terms.distribution, forms, anisotropic};
  }
  /// Whether dd reads sigma and the wavelength.
  [[nodiscard]] bool wave_optics() const noexcept {
    return distribution == DistributionTier::he_torrance || distribution == DistributionTier::he_torrance_series;
  }
};

/// The shape of a surface. What the settings leave unread may hold anything.
template <class T>
struct SurfaceParameters {
  T log_slope{};    ///< ln(sigma/tau), along x
  T log_slope_y{};  ///< ln(sigma/tau_y); read where anisotropic
  T tail{};         ///< gamma of student-t
  T log_sigma{};    ///< ln of sigma in um; read by coh and by He's distribution
};

/// What dd, fs and coh share at one pair.
template <class T>
struct SurfaceTerms {
  T log_height_ratio;        ///< ln(sigma_e / sigma)
  T shadowing_over_cosines;  ///< S / (cos_i cos_r)
};

/// The slope that a direction of azimuth phi meets (LT's k(phi) is its inverse): sigma over the correlation length in
/// that direction, sqrt(cos² m_x² + sin² m_y²). LT (25) as printed takes the mean of the squared lengths instead, which
/// is not the section of the surface that LT (20) describes: with it the dd albedo passes 1 from an axis ratio of 4.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T directional_slope(AnisotropyForm form, const SurfaceParameters<T>& s,
                                                                const G& cos2, const G& sin2) {
  using namespace math;
  const T along = 2.0 * s.log_slope;
  const T across = 2.0 * s.log_slope_y;
  if (form == AnisotropyForm::consistent) return sqrt(cos2 * exp(along) + sin2 * exp(across));
  return 1.0 / sqrt(cos2 * exp(-along) + sin2 * exp(-across));
}

/// S1(c)/c of a tier at the slope that the direction meets.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T shadowing_over_cosine(const ShapeSettings& settings, const T& slope,
                                                                    const T& tail, const G& cos, const G& one_minus_cos,
                                                                    const G& log_one_minus_cos) {
  switch (settings.shadowing) {
    case ShadowingTier::li_torrance:
      return shadowing_li_torrance(T(1.0 / slope), log_one_minus_cos) / cos;
    case ShadowingTier::smith:
      if (settings.distribution == DistributionTier::student_t) {
        return shadowing_student_t_over_cosine(slope, tail, cos, sine(cos, one_minus_cos));
      }
      return shadowing_smith_over_cosine(slope, cos, sine(cos, one_minus_cos));
    case ShadowingTier::schlick:
      return shadowing_schlick_over_cosine(slope, cos);
    case ShadowingTier::none:
      break;
  }
  return T(1.0 / cos);
}

template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T log_height_ratio(EffectiveRoughnessTier tier, const T& slope_i,
                                                               const T& slope_r, const BasicPair<G>& p) {
  switch (tier) {
    case EffectiveRoughnessTier::li_torrance:
      return log_visible_part(T(1.0 / slope_i), p.log_one_minus_cos_i) +
             log_visible_part(T(1.0 / slope_r), p.log_one_minus_cos_r);
    case EffectiveRoughnessTier::he:
      return log_effective_roughness_he(slope_i, slope_r, p);
    case EffectiveRoughnessTier::none:
      break;
  }
  return T(0.0);
}

template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline SurfaceTerms<T> surface_terms(const ShapeSettings& settings,
                                                                          const SurfaceParameters<T>& s,
                                                                          const BasicPair<G>& p) {
  using namespace math;
  const auto at = [&](const T& slope_i, const T& slope_r) __attribute__((always_inline)) {
    return SurfaceTerms<T>{
        log_height_ratio(settings.effective_roughness, slope_i, slope_r, p),
        shadowing_over_cosine(settings, slope_i, s.tail, p.cos_i, p.one_minus_cos_i, p.log_one_minus_cos_i) *
            shadowing_over_cosine(settings, slope_r, s.tail, p.cos_r, p.one_minus_cos_r, p.log_one_minus_cos_r)};
  };
  if (settings.anisotropic) {
    return at(directional_slope(settings.forms.anisotropy, s, p.cos2_phi_i, p.sin2_phi_i),
              directional_slope(settings.forms.anisotropy, s, p.cos2_phi_r, p.sin2_phi_r));
  }
  const T slope = exp(s.log_slope);  // not copied: the copy of a dual number is none that GCC vectorises
  return at(slope, slope);
}

/// ln W(g, x) by the tier: duals by the sum's own derivatives, since it is no chain of elementary functions.
template <class T>
[[nodiscard]] T log_wave_lobe(DistributionTier tier, const T& log_g, const T& x) {
  if (tier == DistributionTier::he_torrance) return log_he_torrance(log_g, x);
  if constexpr (he_torrance::Dual<T>) {
    const auto w = log_he_torrance_series_derivatives(log_g.a, x.a);
    T result(w.value);
    result.v = w.by_log_g * log_g.v + w.by_x * x.v;
    return result;
  } else {
    return log_he_torrance_series(log_g, x);
  }
}

/// What W reads, g = (2 pi sigma_e s_z / lambda)² as its logarithm and x = (pi/lambda)² (s_x² tau_x² + s_y² tau_y²).
/// Of these only g knows sigma_e, which may underflow.
template <class T>
struct WaveArguments {
  T log_g, x;
};
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline WaveArguments<T> wave_arguments(const ShapeSettings& settings,
                                                                            const SurfaceParameters<T>& s,
                                                                            const T& log_ratio, double wavelength_um,
                                                                            const BasicPair<G>& p) {
  using namespace math;
  const G wave_number = 2.0 * pi_of<G>() / G(wavelength_um);
  const T lengths2 = settings.anisotropic ? T(over_m_e2(p.s_x2, s.log_slope) + over_m_e2(p.s_y2, s.log_slope_y))
                                          : over_m_e2(p.s_h2, s.log_slope);
  return {T(2.0 * (log(G(wave_number * p.s_z)) + s.log_sigma + log_ratio)),
          T((wave_number * wave_number / 4.0) * exp(2.0 * s.log_sigma) * lengths2)};
}

/// ln of the lobe: D without (1 + tan²θ_b)²/16, see slope_independent_factor. In the variable
/// y = (s_x²/m_ex² + s_y²/m_ey²)/(4 s_z²), with m_e = sigma_e/tau, the tiers are
///   rough-limit   1/(m_ex m_ey) e^-y
///   student-t     1/(m_ex m_ey) (1 + y/(tail - 1))^-tail
///   he-torrance   1/(m_ex m_ey) g W(g, x),  x = y g
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T log_lobe(const ShapeSettings& settings, const SurfaceParameters<T>& s,
                                                       const T& log_ratio, double wavelength_um,
                                                       const BasicPair<G>& p) {
  using namespace math;
  const T log_m_x = s.log_slope + log_ratio;
  const T log_m_y = settings.anisotropic ? T(s.log_slope_y + log_ratio) : log_m_x;
  const T scale = -log_m_x - log_m_y;
  if (settings.wave_optics()) {
    const WaveArguments<T> w = wave_arguments(settings, s, log_ratio, wavelength_um, p);
    return scale + w.log_g + log_wave_lobe(settings.distribution, w.log_g, w.x);
  }
  const G s_z2 = p.s_z * p.s_z;
  const auto y_at = [&](const T& log_x, const T& log_y) {
    return T(0.25 * (settings.anisotropic ? T(over_m_e2(G(p.s_x2 / s_z2), log_x) + over_m_e2(G(p.s_y2 / s_z2), log_y))
                                          : over_m_e2(p.tan2_b, log_x)));
  };
  if (settings.distribution == DistributionTier::student_t) {
    return scale + student_t_exponent(y_at(s.log_slope, s.log_slope_y), T(-2.0 * log_ratio), s.tail);
  }
  return scale - y_at(log_m_x, log_m_y);
}

/// e^x, x from -infinity on: beside a lobe that sigma_e made infinitely narrow its exponent is infinite, and so is the
/// exponent's derivative. That of a dual number is 0 there, not 0 * infinity.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T exp_of_lobe(const T& x) {
  using namespace math;
  return select(x > -1e300, T(exp(x)), T(0.0));
}

/// S D / (pi cos_i cos_r).
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T dd_shape(const ShapeSettings& settings, const SurfaceParameters<T>& s,
                                                       const SurfaceTerms<T>& t, double wavelength_um,
                                                       const BasicPair<G>& p) {
  using namespace math;
  const T lobe = exp_of_lobe(log_lobe(settings, s, t.log_height_ratio, wavelength_um, p));
  return t.shadowing_over_cosines * (slope_independent_factor(p) / pi_of<G>()) * lobe;
}

/// tan²θ_f / m_e² of the direction that light comes from, whose azimuth decides which slope it runs along: cos²/m_x² +
/// sin²/m_y². (LT print the azimuth of H, which has none at H = N; in the plane of incidence both are the same.)
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T forward_exponent(const ShapeSettings& settings,
                                                               const SurfaceParameters<T>& s, const T& log_ratio,
                                                               const G& tan2, const G& cos2, const G& sin2) {
  if (!settings.anisotropic) return over_m_e2(tan2, T(s.log_slope + log_ratio));
  return over_m_e2(G(tan2 * cos2), T(s.log_slope + log_ratio)) +
         over_m_e2(G(tan2 * sin2), T(s.log_slope_y + log_ratio));
}

/// (1-cos_i)(1-cos_r) exp(-tan²θ_f/(16 m_e²)) / pi on the forward side. `printed` has tan²θ_f of V alone and is not
/// reciprocal (up to 86 % of its maximum for the paper's laser paper); `reciprocal` takes the mean of both orders.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T fs_shape(const ShapeSettings& settings, const SurfaceParameters<T>& s,
                                                       const SurfaceTerms<T>& t, const BasicPair<G>& p) {
  using namespace math;
  T exponent = forward_exponent(settings, s, t.log_height_ratio, p.tan2_f, p.cos2_phi_i, p.sin2_phi_i);
  if (settings.forms.fs == FsForm::reciprocal) {
    const T swapped = forward_exponent(settings, s, t.log_height_ratio, p.tan2_f_swapped, p.cos2_phi_r, p.sin2_phi_r);
    exponent = 0.5 * (exponent + swapped);
  }
  const G reach = p.one_minus_cos_i * p.one_minus_cos_r / pi_of<G>();
  return exp_of_lobe(T(-0.0625 * exponent)) * select(p.forward, reach, G(0.0));
}

/// Whether V lies in the cone of solid angle dOmega about the mirror direction: 2(1 - cos) <= dOmega/pi.
template <class G>
[[nodiscard]] inline bool in_mirror_cone(const BasicPair<G>& p, double solid_angle_sr) {
  return p.mirror_distance2 <= solid_angle_sr / pi;
}

/// S exp(-g) / (cos_i dOmega), g = [2 pi sigma_e (cos_i + cos_r) / lambda]², wherever the caller found the cone. The
/// mirror preserves the source's solid angle: LT (3) prints cos_r in its place, LT (16) does not.
template <class T, class G>
[[nodiscard]] T coh_shape(const SurfaceParameters<T>& s, const SurfaceTerms<T>& t, double wavelength_um,
                          double solid_angle_sr, const BasicPair<G>& p) {
  using namespace math;
  const G wave_number = 2.0 * pi_of<G>() / G(wavelength_um);
  const T phase = wave_number * p.s_z * exp(s.log_sigma + t.log_height_ratio);
  return t.shadowing_over_cosines * (p.cos_r / G(solid_angle_sr)) * exp(-phase * phase);
}

}  // namespace goniofit
