#pragma once
// What the tables hold, as the program computes it: one list for double and for 50 digits, from the same templates.

#include <limits>
#include <string_view>
#include <vector>

#include "basis/optics.h"
#include "brdf/rough_shape.h"
#include "brdf/surface_shape.h"
#include "columns.h"
#include "naive.h"
#include "support/big_pair.h"

namespace goniofit::stability {

using test::Big;
using truth::Inputs;

/// One row: T is the scalar of the parameters, G that of the pair.
template <class T, class G = T>
struct Sample {
  const Inputs& in;
  BasicPair<G> pair;
  SurfaceParameters<T> surface;
  BasicOptics<T> optics;
  T facet_slope;
};

template <class T, class G>
[[nodiscard]] Sample<T, G> sample_of(const Inputs& in, const BasicPair<G>& pair) {
  using namespace math;
  return {in,
          pair,
          {.log_slope = log(T(in.slope)),
           .log_slope_y = log(T(in.slope_y)),
           .tail = T(in.tail),
           .log_sigma = log(T(in.sigma_um))},
          BasicOptics<T>::of_index(T(in.n), T(in.kappa)),
          T(in.facet_slope_deg) * pi_of<T>() / 180.0};
}

/// A value, and its logarithm formed before the value can leave the range of doubles.
template <class T>
struct Outcome {
  T value, log;
};

/// How a column holds its quantity: as it is, as a logarithm of a value, or as the logarithm that the program carries.
enum class Kind { plain, log_of_value, logarithm };

struct Quantity {
  std::string_view name;    ///< in the report
  std::string_view column;  ///< of the tables
  Kind kind;
  Outcome<double> (*in_double)(const Sample<double>&);
  Outcome<Big> (*in_big)(const Sample<Big>&);  ///< null where the tier is a table of doubles
  double (*naive)(const truth::naive::Sample&);
  double ordinary_budget = 1e-12, hard_budget = 1e-9;
};

/// Every column but inputs, derivatives and conditioning; `he-torrance` beside `he-torrance-series`, which has its own
/// budget: what it claims, 1e-9.
[[nodiscard]] const std::vector<Quantity>& quantities();

/// Shape settings by the tiers' initials.
inline constexpr ShapeSettings lt_settings{};
inline constexpr ShapeSettings ht_settings{.shadowing = ShadowingTier::smith,
                                           .effective_roughness = EffectiveRoughnessTier::he,
                                           .distribution = DistributionTier::he_torrance_series,
                                           .forms = {}};

[[nodiscard]] constexpr ShapeSettings with(ShapeSettings s, DistributionTier distribution) {
  s.distribution = distribution;
  return s;
}
[[nodiscard]] constexpr ShapeSettings with(ShapeSettings s, ShadowingTier shadowing) {
  s.shadowing = shadowing;
  return s;
}
[[nodiscard]] constexpr ShapeSettings with(ShapeSettings s, FsForm form) {
  s.forms.fs = form;
  return s;
}
[[nodiscard]] constexpr ShapeSettings anisotropic(ShapeSettings s) {
  s.anisotropic = true;
  return s;
}

template <class T, class G>
[[nodiscard]] Outcome<T> dd(const ShapeSettings& settings, const Sample<T, G>& s) {
  using namespace math;
  const SurfaceTerms<T> t = surface_terms(settings, s.surface, s.pair);
  const T outside = t.shadowing_over_cosines * (slope_independent_factor(s.pair) / pi_of<G>());
  return {dd_shape(settings, s.surface, t, s.in.wavelength_um, s.pair),
          log(outside) + log_lobe(settings, s.surface, t.log_height_ratio, s.in.wavelength_um, s.pair)};
}

/// The logarithm of what lies below the range of doubles has no other maker than the exponent itself.
template <class T, class G>
[[nodiscard]] Outcome<T> fs(const ShapeSettings& settings, const Sample<T, G>& s) {
  using namespace math;
  const BasicPair<G>& p = s.pair;
  const SurfaceTerms<T> t = surface_terms(settings, s.surface, p);
  T exponent = forward_exponent(settings, s.surface, t.log_height_ratio, p.tan2_f, p.cos2_phi_i, p.sin2_phi_i);
  if (settings.forms.fs == FsForm::reciprocal) {
    exponent += forward_exponent(settings, s.surface, t.log_height_ratio, p.tan2_f_swapped, p.cos2_phi_r, p.sin2_phi_r);
    exponent *= 0.5;
  }
  return {fs_shape(settings, s.surface, t, p),
          log(G(p.one_minus_cos_i * p.one_minus_cos_r / pi_of<G>())) - 0.0625 * exponent};
}

template <class T, class G>
[[nodiscard]] Outcome<T> coh(const ShapeSettings& settings, const Sample<T, G>& s) {
  using namespace math;
  const SurfaceTerms<T> t = surface_terms(settings, s.surface, s.pair);
  if (!in_mirror_cone(s.pair, default_solid_angle_sr)) return {T(0.0), T(-std::numeric_limits<double>::infinity())};
  const T g = exp(wave_arguments(settings, s.surface, t.log_height_ratio, s.in.wavelength_um, s.pair).log_g);
  return {coh_shape(s.surface, t, s.in.wavelength_um, default_solid_angle_sr, s.pair),
          log(T(t.shadowing_over_cosines * (s.pair.cos_r / G(default_solid_angle_sr)))) - g};
}

}  // namespace goniofit::stability
