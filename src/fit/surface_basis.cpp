#include "fit/surface_basis.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/settings.h"
#include "fit/shape_derivatives.h"

namespace goniofit {

namespace {

bool uses(EffectSet components, Coefficient c) {
  return std::any_of(all_effects.begin(), all_effects.end(),
                     [&](Effect e) { return components.has(e) && coefficient_of(e) == c; });
}

}  // namespace

SurfaceBasis::SurfaceBasis(EffectSet components, const ShapeSettings& settings, double solid_angle_sr)
    : components_(components), settings_(settings), solid_angle_sr_(solid_angle_sr) {
  for (const Coefficient c : all_coefficients) {
    if (!uses(components, c)) continue;
    const double upper = c == Coefficient::k_fs ? std::numeric_limits<double>::infinity() : 1.0;
    const bool reads_shape = c == Coefficient::k_dd || c == Coefficient::k_fs;
    columns_.push_back({c, optics_factor_of(c), 0.0, upper, reads_shape});
  }
  shape_.push_back({"slope", "", slope_min, slope_max});
  if (components.has(Effect::coh)) shape_.push_back({"sigma_um", "um", sigma_um_min, sigma_um_max});
}

bool SurfaceBasis::reads_later_shape(const Pair& pair) const noexcept {
  return components_.has(Effect::coh) && in_mirror_cone(pair, solid_angle_sr_);
}

double* SurfaceBasis::column_pointer(Coefficient c, std::span<double* const> values) const noexcept {
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    if (columns_[j].coefficient == c) return values[j];
  }
  return nullptr;
}

void SurfaceBasis::shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                                 std::span<double* const> values) const {
  const std::size_t n = pairs.size();
  double* const k_dd = column_pointer(Coefficient::k_dd, values);
  shape_columns(pairs, settings_, log_shape[0], components_.has(Effect::dd) ? k_dd : nullptr,
                column_pointer(Coefficient::k_fs, values));
  if (k_dd != nullptr && !components_.has(Effect::dd)) std::fill_n(k_dd, n, 0.0);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    if (!columns_[j].reads_shape) std::fill_n(values[j], n, 1.0 / pi);
  }
  if (components_.has(Effect::coh)) add_coherent(pairs, log_shape, wavelength_um, k_dd, nullptr, nullptr);
}

void SurfaceBasis::shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                                 std::span<double* const> values, std::span<double* const> derivatives) const {
  const std::size_t n = pairs.size();
  const std::size_t parameters = shape_.size();
  double* dd = nullptr;
  double* d_dd = nullptr;
  double* d_dd_sigma = nullptr;
  double* fs = nullptr;
  double* d_fs = nullptr;
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    double* const by_slope = derivatives[j * parameters];
    if (columns_[j].coefficient == Coefficient::k_dd) {
      dd = values[j];
      d_dd = by_slope;
      if (parameters > 1) d_dd_sigma = derivatives[j * parameters + 1];
    } else if (columns_[j].coefficient == Coefficient::k_fs) {
      fs = values[j];
      d_fs = by_slope;
      if (parameters > 1) std::fill_n(derivatives[j * parameters + 1], n, 0.0);
    } else {
      std::fill_n(values[j], n, 1.0 / pi);
    }
  }
  const bool has_dd = components_.has(Effect::dd);
  shape_columns_with_derivatives(pairs, settings_, log_shape[0], has_dd ? dd : nullptr, has_dd ? d_dd : nullptr, fs,
                                 d_fs);
  if (!components_.has(Effect::coh)) return;
  if (!has_dd) {
    std::fill_n(dd, n, 0.0);
    std::fill_n(d_dd, n, 0.0);
  }
  std::fill_n(d_dd_sigma, n, 0.0);
  add_coherent(pairs, log_shape, wavelength_um, dd, d_dd, d_dd_sigma);
}

// Few directions lie in the mirror cone, so these go one by one, with derivatives by ln slope and ln sigma.
void SurfaceBasis::add_coherent(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                                double* values, double* by_slope, double* by_sigma) const {
  using Dual = ceres::Jet<double, 2>;
  const Dual log_slope(log_shape[0], 0);
  const Dual log_sigma(log_shape[1], 1);
  const Dual q = ceres::exp(-log_slope);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs.mirror_distance2[i] > solid_angle_sr_ / pi) continue;
    const Pair p = pairs[i];
    with_tiers(settings_, [&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness>() {
      const SurfaceTerms<Dual> t = surface_terms<shadowing, roughness>(log_slope, q, p);
      const Dual f = coh_shape(t, log_slope, log_sigma, wavelength_um, solid_angle_sr_, p);
      values[i] += f.a;
      if (by_slope != nullptr) by_slope[i] += f.v[0];
      if (by_sigma != nullptr) by_sigma[i] += f.v[1];
    });
  }
}

}  // namespace goniofit
