#include "fit/surface_basis.h"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "brdf/effects.h"
#include "brdf/shape_kernels.h"
#include "fit/settings.h"

namespace goniofit {

namespace {

constexpr std::size_t most_parameters = 5;

bool uses(EffectSet components, Coefficient c) {
  return std::any_of(all_effects.begin(), all_effects.end(),
                     [&](Effect e) { return components.has(e) && coefficient_of(e) == c; });
}

template <class T>
void put(const T& x, std::size_t i, double* values, double* const* derivatives, std::size_t parameters) {
  if constexpr (std::is_same_v<T, double>) {
    values[i] = x;
  } else {
    values[i] = x.a;
    for (std::size_t k = 0; k < parameters; ++k) derivatives[k][i] = x.v[static_cast<Eigen::Index>(k)];
  }
}

}  // namespace

SurfaceBasis::SurfaceBasis(EffectSet components, const ShapeSettings& settings, double solid_angle_sr)
    : components_(components), settings_(settings), solid_angle_sr_(solid_angle_sr) {
  add_columns();
  add_shape();
}

void SurfaceBasis::add_columns() {
  for (const Coefficient c : all_coefficients) {
    if (!uses(components_, c)) continue;
    const double upper = c == Coefficient::k_fs ? std::numeric_limits<double>::infinity() : 1.0;
    const bool reads_shape = c != Coefficient::k_udf && c != Coefficient::k_uds;
    const std::size_t column = columns_.size();
    if (c == Coefficient::k_dd) dd_ = column;
    if (c == Coefficient::k_fs) fs_ = column;
    if (c == Coefficient::rho) direct_ = column;
    columns_.push_back({coefficients_.size(), optics_factor_of(c), reads_shape, 1});
    coefficients_.push_back({std::string(name_of(c)), 0.0, upper});
  }
  if (!direct_ || settings_.forms.rough == RoughForm::qualitative) return;
  interreflection_ = columns_.size();
  columns_.push_back({columns_[*direct_].coefficient, OpticsFactor::one, true, 2});
}

// Steps of the logarithm. A lobe's width enters as a Gaussian of 1/slope: its dip in the profile is as wide as that,
// some tenths, however narrow the lobe. Beyond a slope of a half the lobe fills the hemisphere and changes little.
// sigma enters coh through exp(-g), g ~ sigma², which is smoother, and so is what a tail or a facet slope does.
void SurfaceBasis::add_shape() {
  constexpr double slope_step = 0.17;
  constexpr double rough = 0.5;
  const auto add = [this](Index& index, ShapeParameter p) {
    index = shape_.size();
    shape_.push_back(std::move(p));
  };
  const bool smith = settings_.shadowing == ShadowingTier::smith;
  const bool lobes = dd_ || fs_;
  if (lobes) add(slope_, {"slope", "", slope_min, slope_max, 0.0, slope_step, rough});
  if (lobes && settings_.anisotropic) {
    add(slope_y_, {"slope_y",
                   "",
                   slope_min,
                   slope_max,
                   0.0,
                   slope_step,
                   rough,
                   {0.03, 0.06, 0.12, 0.2, 0.35, 0.6, 1.0, 1.7, 2.8, 5.0, 8.0, 16.0, 32.0},
                   static_cast<std::ptrdiff_t>(*slope_)});
  }
  const bool reads_tail = components_.has(Effect::dd) || (components_.has(Effect::coh) && smith);
  if (settings_.distribution == DistributionTier::student_t && reads_tail) {
    const double shortest = smith ? smallest_tail_with_smith + 0.01 : tail_min;
    add(tail_, {"tail",
                "",
                shortest,
                tail_max,
                1.0,
                0.5,
                std::numeric_limits<double>::infinity(),
                {1.2, 1.5, 2.0, 3.5, 9.0, 60.0}});
  }
  if (direct_) {
    add(facet_slope_, {"facet_slope_deg",
                       "deg",
                       facet_slope_deg_min,
                       largest_facet_slope_deg,
                       0.0,
                       0.25,
                       std::numeric_limits<double>::infinity(),
                       {4.0, 10.0, 18.0, 30.0, 48.0}});
  }
  const bool wave = components_.has(Effect::dd) && settings_.wave_optics();
  if (components_.has(Effect::coh) || wave) add(sigma_, {"sigma_um", "um", sigma_um_min, sigma_um_max});
}

bool SurfaceBasis::reads_length(const Pair& pair) const noexcept {
  if (components_.has(Effect::dd) && settings_.wave_optics()) return true;
  return components_.has(Effect::coh) && in_mirror_cone(pair, solid_angle_sr_);
}

// Of Gaussian slopes: dd falls as exp(-tan²θ_b / 4m²), fs as exp(-tan²θ_f / 16m²), with sigma_e <= sigma. What stands
// before these is below 10²⁰ in all of the domain of slopes.
double SurfaceBasis::onset(const Pair& pair) const noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nil = 120.0;  // exp(-120) = 10⁻⁵²
  if (!slope_ || !has_kernel(settings_) || facet_slope_ || components_.has(Effect::coh)) return -infinity;
  double least = infinity;
  if (dd_) least = pair.tan2_b / 4.0;
  if (fs_ && pair.forward) {
    const bool printed = settings_.forms.fs == FsForm::printed;
    const double tan2 = printed ? pair.tan2_f : std::min(pair.tan2_f, pair.tan2_f_swapped);
    least = std::min(least, tan2 / 16.0);
  }
  return 0.5 * std::log(least / nil);
}

template <class T>
SurfaceParameters<T> SurfaceBasis::parameters(std::span<const double> z) const {
  const auto get = [&](const Index& index, double otherwise) {
    if (!index) return T(otherwise);
    if constexpr (std::is_same_v<T, double>) {
      return z[*index];
    } else {
      return T(z[*index], static_cast<int>(*index));
    }
  };
  using std::exp;
  SurfaceParameters<T> s;
  s.log_slope = get(slope_, 0.0);
  s.log_slope_y = get(slope_y_, 0.0);
  s.tail = 1.0 + exp(get(tail_, 0.0));
  s.log_sigma = get(sigma_, 0.0);
  return s;
}

SurfaceBasis::Targets SurfaceBasis::targets(std::span<double* const> values,
                                            std::span<double* const> derivatives) const {
  const auto target = [&](const Index& column) -> Target {
    if (!column) return {};
    return {values[*column], derivatives.empty() ? nullptr : derivatives.data() + *column * shape_.size()};
  };
  return {target(dd_), target(fs_), target(direct_), target(interreflection_)};
}

const std::vector<SurfaceTerms<double>>& SurfaceBasis::remembered_terms(const PairBatch& pairs,
                                                                        std::span<const double> z) const {
  const std::span<const double> slopes = z.first(shape_.size() - (has_length() ? 1 : 0));
  Remembered& r = remembered_;
  const bool same = r.batch == pairs.cos_i.data() && r.terms.size() == pairs.size() &&
                    std::equal(slopes.begin(), slopes.end(), r.slopes.begin(), r.slopes.end());
  if (same) return r.terms;
  r.batch = pairs.cos_i.data();
  r.slopes.assign(slopes.begin(), slopes.end());
  r.terms.clear();
  const SurfaceParameters<double> s = parameters<double>(z);
  for (std::size_t i = 0; i < pairs.size(); ++i) r.terms.push_back(surface_terms(settings_, s, pairs[i]));
  return r.terms;
}

// One by one, every tier and form.
template <class T>
void SurfaceBasis::fill_surface(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                                const Targets& out) const {
  const SurfaceParameters<T> s = parameters<T>(z);
  const std::vector<SurfaceTerms<double>>* remembered = nullptr;
  if (std::is_same_v<T, double>) remembered = &remembered_terms(pairs, z);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair p = pairs[i];
    SurfaceTerms<T> t;
    if constexpr (std::is_same_v<T, double>) {
      t = (*remembered)[i];
    } else {
      t = surface_terms(settings_, s, p);
    }
    if (out.dd.values != nullptr) {
      T dd(0.0);
      if (components_.has(Effect::dd)) dd = dd_shape(settings_, s, t, wavelength_um, p);
      if (components_.has(Effect::coh) && in_mirror_cone(p, solid_angle_sr_)) {
        dd += coh_shape(s, t, wavelength_um, solid_angle_sr_, p);
      }
      put(dd, i, out.dd.values, out.dd.derivatives, shape_.size());
    }
    if (out.fs.values != nullptr) {
      put(fs_shape(settings_, s, t, p), i, out.fs.values, out.fs.derivatives, shape_.size());
    }
  }
}

// By the vectorised loops, which know the slope alone; it is the first shape parameter.
void SurfaceBasis::fill_by_kernel(const PairBatch& pairs, std::span<const double> z, const Targets& out) const {
  const bool has_dd = components_.has(Effect::dd);
  const bool derivatives = (out.dd.derivatives != nullptr) || (out.fs.derivatives != nullptr);
  double* const dd = has_dd ? out.dd.values : nullptr;
  if (!has_dd && out.dd.values != nullptr) std::fill_n(out.dd.values, pairs.size(), 0.0);
  if (!derivatives) return shape_columns(pairs, settings_, z[*slope_], dd, out.fs.values);
  for (const Target* target : {&out.dd, &out.fs}) {
    if (target->values == nullptr) continue;
    for (std::size_t k = 0; k < shape_.size(); ++k) std::fill_n(target->derivatives[k], pairs.size(), 0.0);
  }
  const auto column = [&](bool used, const Target& target) {
    return used ? ColumnWithDerivative{target.values, target.derivatives[*slope_]} : ColumnWithDerivative{};
  };
  shape_columns(pairs, settings_, z[*slope_], column(has_dd, out.dd), column(out.fs.values != nullptr, out.fs));
}

// Few directions lie in the mirror cone, so beside the kernels these go one by one.
void SurfaceBasis::add_coherent(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                                const Target& dd) const {
  using Dual = ceres::Jet<double, most_parameters>;
  const SurfaceParameters<Dual> s = parameters<Dual>(z);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs.mirror_distance2[i] > solid_angle_sr_ / pi) continue;
    const Pair p = pairs[i];
    const Dual f = coh_shape(s, surface_terms(settings_, s, p), wavelength_um, solid_angle_sr_, p);
    dd.values[i] += f.a;
    for (std::size_t k = 0; dd.derivatives != nullptr && k < shape_.size(); ++k) {
      dd.derivatives[k][i] += f.v[static_cast<Eigen::Index>(k)];
    }
  }
}

// The integral takes its time, but what of it does not read the facet slope is the same in all of a search: it is kept
// for each batch of pairs.
const std::vector<VCavityTable>& SurfaceBasis::cavities(const PairBatch& pairs) const {
  double key = 0.0;  // any value that tells the few batches of a fit apart
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    key += static_cast<double>(i + 1) * (pairs.cos_i[i] + 2.0 * pairs.cos_r[i] + 3.0 * pairs.dot_h[i]);
  }
  const auto [at, is_new] = cavities_.try_emplace({key, static_cast<double>(pairs.size())});
  if (is_new) {
    at->second.reserve(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      at->second.emplace_back(pairs[i], radians(facet_slope_deg_min), radians(largest_facet_slope_deg),
                              v_cavity_tolerance);
    }
  }
  return at->second;
}

void SurfaceBasis::fill_rough(const PairBatch& pairs, double facet_slope_deg, const Targets& out) const {
  using Dual = ceres::Jet<double, 1>;
  const bool integral = settings_.forms.rough == RoughForm::integral;
  const double value = radians(facet_slope_deg);
  const std::vector<VCavityTable>* const table = integral ? &cavities(pairs) : nullptr;
  // d/dz of a parameter that is exp(z).
  const auto put_dual = [&](const Target& target, std::size_t i, const Dual& x) {
    if (target.values == nullptr) return;
    target.values[i] = x.a / pi;
    for (std::size_t k = 0; target.derivatives != nullptr && k < shape_.size(); ++k) {
      target.derivatives[k][i] = k == *facet_slope_ ? x.v[0] * value / pi : 0.0;
    }
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    RoughFactors<Dual> f;
    if (integral) {
      const VCavities v = (*table)[i].at(value);
      f.direct = Dual(v.direct);
      f.direct.v[0] = v.direct_by_facet_slope;
      f.interreflection = Dual(v.interreflection);
      f.interreflection.v[0] = v.interreflection_by_facet_slope;
    } else {
      f = closed_rough_factors(settings_.forms.rough, Dual(value, 0), pairs[i]);
    }
    put_dual(out.direct, i, f.direct);
    put_dual(out.interreflection, i, f.interreflection);
  }
}

void SurfaceBasis::fill(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                        std::span<double* const> values, std::span<double* const> derivatives) const {
  const Targets out = targets(values, derivatives);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    if (!columns_[j].reads_shape) std::fill_n(values[j], pairs.size(), 1.0 / pi);
  }
  if (slope_ && (derivatives.empty() ? has_kernel(settings_) : has_derivative_kernel(settings_))) {
    fill_by_kernel(pairs, z, out);
    if (components_.has(Effect::coh)) add_coherent(pairs, z, wavelength_um, out.dd);
  } else if (slope_ && derivatives.empty()) {
    fill_surface<double>(pairs, z, wavelength_um, out);
  } else if (slope_ && shape_.size() <= 2) {
    fill_surface<ceres::Jet<double, 2>>(pairs, z, wavelength_um, out);
  } else if (slope_) {
    fill_surface<ceres::Jet<double, most_parameters>>(pairs, z, wavelength_um, out);
  }
  if (facet_slope_) fill_rough(pairs, std::exp(z[*facet_slope_]), out);
}

void SurfaceBasis::shape_factors(const Pair& pair, std::span<const double> z, double wavelength_um,
                                 std::span<double> values) const {
  remembered_.batch = nullptr;  // the address of a temporary says nothing
  PairBatch one;
  one.push_back(pair);
  std::vector<double*> pointers;
  for (double& value : values.first(columns_.size())) pointers.push_back(&value);
  fill(one, z, wavelength_um, pointers, {});
}

void SurfaceBasis::shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                                 std::span<double* const> values) const {
  fill(pairs, z, wavelength_um, values, {});
}

void SurfaceBasis::shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                                 std::span<double* const> values, std::span<double* const> derivatives) const {
  fill(pairs, z, wavelength_um, values, derivatives);
}

}  // namespace goniofit
