#include "cli/model_catalogue.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "brdf/material.h"
#include "fit/settings.h"
#include "peers/peers.h"

namespace goniofit::cli {
namespace {

// Names come from the library, so that they cannot differ from what files and flags accept.
template <class E>
TierEntry tier(E value, E chosen_by_default, std::string meaning) {
  return {std::string(name_of(value)), std::move(meaning), value == chosen_by_default};
}

EffectEntry effect(Effect e, std::string formula, std::string meaning) {
  return {std::string(name_of(e)), std::string(name_of(coefficient_of(e))), std::move(formula), std::move(meaning)};
}

constexpr double infinity = std::numeric_limits<double>::infinity();

ParameterEntry shared(std::string name, std::string unit, double min, double max, std::string meaning) {
  return {std::move(name), std::move(unit), "shared", min, max, std::move(meaning)};
}

ParameterEntry of_channel(std::string name, double min, double max, std::string meaning) {
  return {std::move(name), "", "channel", min, max, std::move(meaning)};
}

ParameterEntry coefficient(Coefficient c, double max, std::string meaning) {
  return of_channel(std::string(name_of(c)), 0.0, max, std::move(meaning));
}

}  // namespace

std::vector<EffectEntry> effect_catalogue() {
  return {
      effect(Effect::coh, "k_dd F S exp(-g) / (cos_i dOmega)",
             "mirror reflection of the mean plane, inside the mirror cone"),
      effect(Effect::dd, "k_dd F S D / (pi cos_i cos_r)", "directional-diffuse reflection of the rough surface"),
      effect(Effect::udf, "k_udf / pi", "uniform-diffuse light from multiple surface reflections"),
      effect(Effect::uds, "k_uds / pi T(cos_i) T(cos_r)", "uniform-diffuse light from below the surface"),
      effect(Effect::fs, "k_fs / pi T T (1-cos_i)(1-cos_r) exp(-tan²theta_f / 16 m²)",
             "forward scattering from below the surface"),
      effect(Effect::rough, "rho / pi (L1 + rho L2), of V-shaped grooves",
             "diffuse reflection of a matt rough surface (Oren & Nayar 1994)"),
  };
}

std::vector<TermEntry> term_catalogue() {
  const Terms chosen;
  const Forms forms;
  return {
      {"fresnel",
       {tier(FresnelTier::schlick, chosen.fresnel, "f0 + (1 - f0)(1 - u)⁵"),
        tier(FresnelTier::exact, chosen.fresnel, "Fresnel's equations with n + i kappa, unpolarised"),
        tier(FresnelTier::none, chosen.fresnel, "F = 1")}},
      {"shadowing",
       {tier(ShadowingTier::li_torrance, chosen.shadowing, "S1(cos_i) S1(cos_r), S1(c) = 1 - (1 - c)^(tau/sigma)"),
        tier(ShadowingTier::smith, chosen.shadowing, "Smith 1967, of Gaussian slopes, or of student-t's"),
        tier(ShadowingTier::schlick, chosen.shadowing, "Schlick's rational fit, c / (c (1 - q) + q)"),
        tier(ShadowingTier::none, chosen.shadowing, "S = 1")}},
      {"effective_roughness",
       {tier(EffectiveRoughnessTier::li_torrance, chosen.effective_roughness,
             "sigma_e of the lit and seen parts, closed form"),
        tier(EffectiveRoughnessTier::he, chosen.effective_roughness,
             "He et al. 1991, the root of a transcendental equation"),
        tier(EffectiveRoughnessTier::none, chosen.effective_roughness, "sigma_e = sigma")}},
      {"distribution",
       {tier(DistributionTier::rough_limit, chosen.distribution, "Gaussian slopes, the limit of large g"),
        tier(DistributionTier::he_torrance, chosen.distribution, "wave optics of He et al. 1991; needs wavelengths"),
        tier(DistributionTier::he_torrance_series, chosen.distribution,
             "the same by the plain sum: slow, the yardstick"),
        tier(DistributionTier::student_t, chosen.distribution, "slopes with long tails; tail 2 is GGX")}},
      {"fs",
       {tier(FsForm::printed, forms.fs, "as published; not reciprocal"),
        tier(FsForm::reciprocal, forms.fs, "tan²theta_f averaged over both orders of the directions")}},
      {"rough",
       {tier(RoughForm::functional, forms.rough, "Oren & Nayar's fit to the integral, with interreflection"),
        tier(RoughForm::integral, forms.rough, "the integral over grooves itself: slow, the yardstick"),
        tier(RoughForm::qualitative, forms.rough, "the fit without all but its leading terms")}},
      {"anisotropy",
       {tier(AnisotropyForm::consistent, forms.anisotropy, "each direction meets the slope of the surface's section"),
        tier(AnisotropyForm::printed, forms.anisotropy, "Li & Torrance (25) as printed, for comparison")}},
  };
}

std::vector<ParameterEntry> parameter_catalogue() {
  return {
      shared("slope", "", slope_min, slope_max, "sigma / tau; the Beckmann roughness is twice that"),
      shared("sigma_um", "um", sigma_um_min, sigma_um_max,
             "RMS height; known through coh, the distribution he-torrance or a fixed value only"),
      shared("tau_um", "um", 0.0, infinity, "correlation length, sigma / slope; known where sigma is"),
      shared("slope_y", "", slope_min, slope_max,
             "sigma / tau_y of an anisotropic surface, whose slope is that along x"),
      shared("tau_y_um", "um", 0.0, infinity, "sigma / slope_y; known where sigma is"),
      shared("tail", "", tail_min, tail_max, "of the distribution student-t: 2 is GGX, infinity Gaussian slopes"),
      shared("facet_slope_deg", "deg", facet_slope_deg_min, largest_facet_slope_deg,
             "of rough: standard deviation of the grooves' slope angle"),
      coefficient(Coefficient::k_dd, 1.0, "of coh and dd"),
      coefficient(Coefficient::k_udf, 1.0, "of udf"),
      coefficient(Coefficient::k_uds, 1.0, "of uds"),
      coefficient(Coefficient::k_fs, infinity, "of fs"),
      coefficient(Coefficient::rho, 1.0, "of rough: the albedo of its facets"),
      of_channel("n", n_min, n_max, "refractive index; given, or free with --free n"),
      of_channel("kappa", 0.0, infinity, "absorption index; given"),
      of_channel("f0", 0.0, 1.0, "normal reflectance in place of n and kappa; given, or free with --free f0"),
  };
}

std::vector<PeerEntry> peer_entries() {
  std::vector<PeerEntry> entries;
  for (const PeerInfo& info : peer_catalogue()) {
    const std::unique_ptr<const Basis> basis = make_peer(info.name);
    PeerEntry entry{std::string(info.name), std::string(info.description), std::string(info.paper), {}, false};
    for (const ShapeParameter& p : basis->shape_parameters()) {
      entry.parameters.push_back(shared(p.name, p.unit, p.lower, p.upper, ""));
    }
    for (const BasisCoefficient& c : basis->coefficients()) {
      if (!c.constant()) entry.parameters.push_back(of_channel(c.name, c.lower, c.upper, ""));
    }
    entry.reads_fresnel = std::any_of(basis->columns().begin(), basis->columns().end(),
                                      [](const BasisColumn& c) { return c.optics != OpticsFactor::one; });
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace goniofit::cli
