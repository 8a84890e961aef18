#include "brdf/surface_program.h"

#include <algorithm>
#include <numbers>

#include "brdf/effects.h"
#include "brdf/rough_shape.h"
#include "terms/he_torrance_block.h"
#include "terms/he_torrance_series.h"

namespace goniofit::batch {

namespace {

using block::Field;
using block::Fields;
using block::Use;

Use use_of(FresnelTier tier) noexcept {
  switch (tier) {
    case FresnelTier::schlick:
      return Use::schlick;
    case FresnelTier::exact:
      return Use::array;
    case FresnelTier::none:
      break;
  }
  return Use::constant;
}

// A value of either precision that no caller needs to tell from infinity.
template <class Real>
constexpr Real most_value = std::is_same_v<Real, float> ? Real(1e30) : Real(saturation);

template <class Real>
block::Polynomial<Real> rounded(const FittedPolynomial& p) {
  block::Polynomial<Real> out{static_cast<Real>(p.scale), static_cast<Real>(p.offset), {}};
  std::transform(p.c.begin(), p.c.end(), out.c.begin(), [](double c) { return static_cast<Real>(c); });
  return out;
}

// Of each term, for a tolerance of the whole: the exponent of a lobe multiplies the error of sigma_e by ten or so where
// there is any light. W of wave optics is good to 1e-9 itself.
double term_tolerance(double tolerance, bool wave) noexcept {
  constexpr double of_wave = 2e-10;
  return wave ? std::max(of_wave, 0.05 * tolerance) : 0.05 * tolerance;
}

// No loop has an azimuth, and student-t's own shadowing is a quadrature.
bool needs_pairs(const ShapeSettings& s, bool dd) noexcept {
  const bool quadrature = s.distribution == DistributionTier::student_t && s.shadowing == ShadowingTier::smith;
  return s.anisotropic || (dd && quadrature);
}

}  // namespace

template <class Out, class Real>
SurfaceProgram<Out, Real>::SurfaceProgram(const Material& material, const CompileSettings& settings)
    : scalar_(material),
      set_(settings.instructions),
      shape_(ShapeSettings::of(material.terms, material.forms, material.surface.anisotropic())) {
  plan_channels();
  plan_shared(settings);
  plan_curves(settings.tolerance);
  plan_loops();
  add_fields();
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::plan_channels() {
  const Material& m = scalar_.material();
  const FresnelTier tier = m.terms.fresnel;
  for (const MaterialChannel& c : m.channels) {
    const auto k = [&](Effect e) { return m.components.has(e) ? c.coefficient(coefficient_of(e)).value_or(0.0) : 0.0; };
    ChannelPlan<Real> p;
    const double n = c.n.value_or(1.0);
    const double kappa = c.kappa.value_or(0.0);
    const double f0 = c.normal_reflectance();
    const double t0 = c.f0 ? 1.0 - f0 : normal_transmission(n, kappa);
    p.index = static_cast<Real>(n);
    p.kappa = static_cast<Real>(kappa);
    p.wavelength_um = c.wavelength_um.value_or(1.0);
    if (const double k_dd = k(Effect::dd); k_dd != 0.0) {
      p.mirror = use_of(tier);
      p.mirror_0 = static_cast<Real>(tier == FresnelTier::schlick ? k_dd * f0 : tier == FresnelTier::none ? k_dd : 0.0);
      p.mirror_1 = static_cast<Real>(tier == FresnelTier::schlick ? k_dd * t0 : k_dd);
    }
    const double k_uds = k(Effect::uds);
    const double k_fs = k(Effect::fs);
    if (k_uds != 0.0 || k_fs != 0.0) {
      const double scale = tier == FresnelTier::schlick ? t0 * t0 : 1.0;
      p.below = use_of(tier);
      p.below_0 = static_cast<Real>(k_uds * scale / pi);
      p.below_1 = static_cast<Real>(k_fs * scale);
      p.fs = k_fs != 0.0;
    }
    p.diffuse = static_cast<Real>(k(Effect::udf) / pi);
    p.rho = static_cast<Real>(k(Effect::rough));
    p.rough = p.rho != Real(0);
    p.coherent = k(Effect::coh) != 0.0;
    if (!plans_.empty()) {
      const ChannelPlan<Real>& before = plans_.back();
      p.new_optics =
          p.index != before.index || p.kappa != before.kappa || before.mirror != p.mirror || before.below != p.below;
      p.new_wavelength = p.wavelength_um != before.wavelength_um || before.mirror == Use::absent;
    }
    plans_.push_back(p);
  }
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::plan_shared(const CompileSettings& settings) {
  const Surface& s = scalar_.material().surface;
  for (const ChannelPlan<Real>& p : plans_) {
    dd_ = dd_ || p.mirror != Use::absent;
    fs_ = fs_ || p.fs;
    rough_ = rough_ || p.rough;
    coherent_ = coherent_ || p.coherent;
  }
  wave_ = dd_ && shape_.wave_optics();
  by_pair_ = needs_pairs(shape_, dd_);
  grows_ = shape_.effective_roughness != EffectiveRoughnessTier::none;
  const double slope = s.slope.value_or(1.0);
  slope_ = static_cast<Real>(slope);
  log_slope_ = static_cast<Real>(std::log(slope));
  tail_ = static_cast<Real>(s.tail.value_or(2.0));
  log_sigma_ = std::log(s.sigma_um.value_or(1.0));
  unit_shadowing_from_ = static_cast<Real>(settings.shadowing_shortcut ? -std::expm1(slope * std::log(0.005)) : 2.0);
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::plan_curves(double tolerance) {
  // Single precision has no digits for more than this.
  if (std::is_same_v<Real, float>) tolerance = std::max(tolerance, 2e-5);
  if (tolerance == 0.0 && !(wave_ && shape_.distribution == DistributionTier::he_torrance)) return;
  const double each = term_tolerance(tolerance, wave_);
  constexpr auto arithmetic =
      std::is_same_v<Real, float> ? PolynomialArithmetic::binary32 : PolynomialArithmetic::binary64;
  for (ChannelPlan<Real>& p : plans_) {
    const double kappa = static_cast<double>(p.kappa);
    const double n = static_cast<double>(p.index);
    if (const auto f = p.mirror == Use::array ? reflection_curve(n, kappa, each, arithmetic) : std::nullopt) {
      p.fresnel_curve = rounded<Real>(*f);
      p.fresnel_curve_loop = block::fresnel_curve<Real>(f->c.size(), set_);
    }
    if (const auto t = p.below == Use::array ? transmission_curve(n, kappa, each, arithmetic) : std::nullopt) {
      p.transmission_curve = rounded<Real>(*t);
      p.transmission_curve_loop = block::transmission_curve<Real>(t->c.size(), set_);
    }
  }
  const bool fs_grows = fs_ && grows_;
  if (shape_.anisotropic || (!dd_ && !fs_grows)) return;
  const auto c =
      visibility_curves(shape_, dd_, static_cast<double>(slope_), static_cast<double>(tail_), each, arithmetic);
  if (!c) return;
  by_pair_ = false;
  curves_ = {rounded<Real>(c->lit),
             rounded<Real>(c->seen),
             rounded<Real>(c->growth),
             static_cast<Real>(c->lit_reach),
             static_cast<Real>(c->seen_reach),
             block::curves<Real>(dd_, shape_.effective_roughness, c->coefficients(), set_)};
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::plan_loops() {
  if (!by_pair_) {
    const bool fs_grows = fs_ && grows_;
    if (!curves_ && (dd_ || fs_grows))
      visibility_ = block::visibility<Real>(dd_, shape_.shadowing, shape_.effective_roughness, set_);
    if (dd_ && !wave_) dd_loop_ = block::directional_diffuse<Real>(shape_.distribution, grows_, set_);
    if (fs_) fs_loop_ = block::forward_scattering<Real>(shape_.forms.fs, grows_, set_);
    if (wave_) {
      wave_arguments_ = block::wave_arguments_loop<Real>(grows_, set_);
      wave_lobe_ = block::wave_lobe<Real>(grows_, set_);
    }
  }
  if (rough_) rough_loop_ = block::rough<Real>(scalar_.material().forms.rough, set_);
  if (rough_) add_rough_ = block::add_rough<Real, Out>(set_);
  fresnel_ = block::exact_fresnel<Real>(set_);
  transmission_ = block::exact_transmission<Real>(set_);
  for (const ChannelPlan<Real>& p : plans_) {
    combine_.push_back(block::combine<Real, Out>(p.mirror, p.below, p.fs, set_));
  }
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::add_fields() {
  using enum Field;
  fields_ |= {cos_i, cos_r};
  if (visibility_ != nullptr) fields_ |= block::fields_of(dd_, shape_.shadowing, shape_.effective_roughness);
  if (dd_ && !by_pair_) fields_ |= {tan2_b};
  if (wave_ && !by_pair_) fields_ |= {s_z, s_h2};
  if (fs_loop_ != nullptr) fields_ |= {one_minus_cos_i, one_minus_cos_r, tan2_f, forward};
  if (fs_loop_ != nullptr && shape_.forms.fs == FsForm::reciprocal) fields_ |= {tan2_f_swapped};
  if (rough_loop_ != nullptr) fields_ |= block::rough_fields(scalar_.material().forms.rough);
  if (coherent_) fields_ |= {mirror_distance2};
  for (const ChannelPlan<Real>& p : plans_) {
    if (p.mirror == Use::schlick || p.mirror == Use::array) fields_ |= {cos_h, one_minus_cos_h};
    if (p.below == Use::array && !p.transmission_curve) fields_ |= {one_minus_cos_i, one_minus_cos_r};
  }
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_blocks(const Source& source, std::span<Out> result) const {
  Workspace w;
  for (std::size_t first = 0; first < source.size(); first += block::size) {
    const std::size_t n = std::min(block::size, source.size() - first);
    source.prepare(first, n, w.fields, w.geometry);
    run_shared(source, first, n, w);
    for (std::size_t c = 0; c < plans_.size(); ++c) {
      Out* const out = result.data() + c * source.size() + first;
      const bool whole = whole_vectors(n) == n;
      run_channel(source, c, first, n, w, whole ? out : w.out.data());
      if (!whole) std::copy_n(w.out.begin(), n, out);
    }
  }
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_shared(const Source& source, std::size_t first, std::size_t n, Workspace& w) const {
  run_visibility(source, first, n, w);
  const block::LobeArguments<Real> lobe{w.geometry, &w.terms, whole_vectors(n), log_slope_, Real(1) / (slope_ * slope_),
                                        tail_};
  if (dd_loop_ != nullptr) dd_loop_(lobe);
  if (fs_loop_ != nullptr) fs_loop_(lobe);
  if (by_pair_ && !wave_ && (dd_ || fs_)) run_shapes_by_pair(source, first, n, 1.0, w);
  if (rough_) run_rough(source, first, n, w);
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_rough(const Source& source, std::size_t first, std::size_t n, Workspace& w) const {
  const Material& m = scalar_.material();
  const double facet_slope = radians(m.surface.facet_slope_deg.value_or(0.0));
  if (rough_loop_ != nullptr) {
    rough_loop_({w.geometry, &w.terms, whole_vectors(n), static_cast<Real>(facet_slope)});
    return;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Pair p = source.pair(first + k);
    if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0)) continue;
    const RoughFactors<double> f = rough_factors(m.forms.rough, facet_slope, p);
    w.terms.direct[k] = static_cast<Real>(f.direct);
    w.terms.interreflection[k] = static_cast<Real>(f.interreflection);
  }
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_visibility(const Source& source, std::size_t first, std::size_t n,
                                               Workspace& w) const {
  if (visibility_ != nullptr) {
    visibility_({w.geometry, &w.terms, whole_vectors(n), slope_, Real(1) / slope_, log_slope_, unit_shadowing_from_});
  }
  if (!curves_) return;
  const SharedCurves& c = *curves_;
  c.loop({w.geometry, &w.terms, whole_vectors(n), &c.lit, &c.seen, &c.growth, c.lit_reach, c.seen_reach,
          Real(1) / slope_, log_slope_});
  if (shape_.effective_roughness != EffectiveRoughnessTier::he) return;
  const Real* const cos_i = w.geometry[Field::cos_i];
  const Real* const cos_r = w.geometry[Field::cos_r];
  for (std::size_t k = 0; k < n; ++k) {
    if (!(std::min(cos_i[k], cos_r[k]) < Real(he_curve_horizon))) continue;
    const Pair p = source.pair(first + k);
    if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0)) continue;
    const double growth = -2.0 * log_effective_roughness_he(static_cast<double>(slope_), p);
    w.terms.growth[k] = static_cast<Real>(growth);
    w.terms.inverse_m_e2[k] = static_cast<Real>(std::exp(growth - 2.0 * static_cast<double>(log_slope_)));
  }
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::run_optics(const ChannelPlan<Real>& p, std::size_t n, Workspace& w) const {
  const block::FresnelArguments<Real> optics{w.geometry, &w.terms, whole_vectors(n), p.index, p.kappa};
  if (p.mirror == Use::array) {
    p.fresnel_curve ? p.fresnel_curve_loop({w.geometry, &w.terms, whole_vectors(n), &*p.fresnel_curve})
                    : fresnel_(optics);
  }
  if (p.below == Use::array) {
    p.transmission_curve ? p.transmission_curve_loop({w.geometry, &w.terms, whole_vectors(n), &*p.transmission_curve})
                         : transmission_(optics);
  }
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_shapes_by_pair(const Source& source, std::size_t first, std::size_t n,
                                                   double wavelength_um, Workspace& w) const {
  const Surface& surface = scalar_.material().surface;
  const SurfaceParameters<double> s{.log_slope = std::log(surface.slope.value_or(1.0)),
                                    .log_slope_y = std::log(surface.slope_y.value_or(1.0)),
                                    .tail = surface.tail.value_or(2.0),
                                    .log_sigma = log_sigma_};
  constexpr double most = most_value<Real>;
  std::fill(w.terms.dd.begin(), w.terms.dd.end(), Real(0));
  std::fill(w.terms.fs.begin(), w.terms.fs.end(), Real(0));
  for (std::size_t k = 0; k < n; ++k) {
    const Pair p = source.pair(first + k);
    if (!(p.cos_i > 0.0) || !(p.cos_r > 0.0)) continue;
    const SurfaceTerms<double> t = surface_terms(shape_, s, p);
    if (dd_) w.terms.dd[k] = static_cast<Real>(std::min(most, dd_shape(shape_, s, t, wavelength_um, p)));
    if (fs_) w.terms.fs[k] = static_cast<Real>(fs_shape(shape_, s, t, p));
  }
}

template <class Out, class Real>
void SurfaceProgram<Out, Real>::run_wave(const ChannelPlan<Real>& plan, std::size_t n, Workspace& w) const {
  const double wave_number = 2.0 * pi / plan.wavelength_um;
  const double half_tau = 0.5 * wave_number * std::exp(log_sigma_) / static_cast<double>(slope_);
  const block::WaveLoopArguments<Real> a{w.geometry,
                                         &w.terms,
                                         whole_vectors(n),
                                         log_slope_,
                                         static_cast<Real>(std::log(wave_number) + log_sigma_),
                                         static_cast<Real>(half_tau * half_tau)};
  wave_arguments_(a);
  if (shape_.distribution == DistributionTier::he_torrance_series) {
    for (std::size_t k = 0; k < n; ++k) {
      const double log_w = log_he_torrance_series(double(w.terms.log_g[k]), double(w.terms.x[k]));
      w.terms.log_w[k] = static_cast<Real>(log_w);
    }
  } else if constexpr (std::is_same_v<Real, double>) {
    log_he_torrance_block(w.terms.log_g.data(), w.terms.x.data(), whole_vectors(n), w.terms.log_w.data(),
                          HeTorranceAccuracy::fine, set_);
  } else {
    log_he_torrance_block(w.terms.log_g.data(), w.terms.x.data(), whole_vectors(n), w.terms.log_w.data(), set_);
  }
  wave_lobe_(a);
}

template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::run_channel(const Source& source, std::size_t channel, std::size_t first, std::size_t n,
                                            Workspace& w, Out* out) const {
  const ChannelPlan<Real>& p = plans_[channel];
  if (wave_ && p.mirror != Use::absent && p.new_wavelength) {
    if (by_pair_) {
      run_shapes_by_pair(source, first, n, p.wavelength_um, w);
    } else {
      run_wave(p, n, w);
    }
  }
  if (p.new_optics) run_optics(p, n, w);
  combine_[channel]({w.geometry, &w.terms, whole_vectors(n), p.mirror_0, p.mirror_1, p.below_0, p.below_1, p.diffuse,
                     most_value<Real>, out});
  if (p.rough) add_rough_({w.geometry, &w.terms, whole_vectors(n), p.rho, most_value<Real>, out});
  if (p.coherent) add_coherent(source, channel, first, n, w, out);
}

// Few pairs lie in the cone.
template <class Out, class Real>
template <class Source>
void SurfaceProgram<Out, Real>::add_coherent(const Source& source, std::size_t channel, std::size_t first,
                                             std::size_t n, const Workspace& w, Out* out) const {
  const Real* const distance2 = w.geometry[Field::mirror_distance2];
  const auto reach = static_cast<Real>(scalar_.material().solid_angle_sr / pi);
  for (std::size_t k = 0; k < n; ++k) {
    if (!(distance2[k] <= reach)) continue;
    const double coherent = scalar_.value(source.pair(first + k), channel, Effect::coh);
    out[k] = static_cast<Out>(std::min<double>(double(out[k]) + coherent, most_value<Real>));
  }
}

template class SurfaceProgram<double, double>;
template class SurfaceProgram<float, float>;
template class SurfaceProgram<double, float>;

}  // namespace goniofit::batch
