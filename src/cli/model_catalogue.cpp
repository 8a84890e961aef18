#include "cli/model_catalogue.h"

#include "brdf/material.h"
#include "fit/settings.h"

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

ParameterEntry coefficient(Coefficient c, double max, std::string meaning) {
  return {.name = std::string(name_of(c)),
          .unit = "",
          .scope = "channel",
          .min = 0.0,
          .max = max,
          .meaning = std::move(meaning)};
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
  };
}

std::vector<TermEntry> term_catalogue() {
  const Terms chosen;
  return {
      {"fresnel",
       {tier(FresnelTier::schlick, chosen.fresnel, "f0 + (1 - f0)(1 - u)⁵"),
        tier(FresnelTier::exact, chosen.fresnel, "Fresnel's equations with n + i kappa, unpolarised"),
        tier(FresnelTier::none, chosen.fresnel, "F = 1")}},
      {"shadowing",
       {tier(ShadowingTier::li_torrance, chosen.shadowing, "S1(cos_i) S1(cos_r), S1(c) = 1 - (1 - c)^(tau/sigma)"),
        tier(ShadowingTier::none, chosen.shadowing, "S = 1")}},
      {"effective_roughness",
       {tier(EffectiveRoughnessTier::li_torrance, chosen.effective_roughness,
             "sigma_e of the lit and seen parts, closed form"),
        tier(EffectiveRoughnessTier::none, chosen.effective_roughness, "sigma_e = sigma")}},
      {"distribution",
       {tier(DistributionTier::rough_limit, chosen.distribution, "Gaussian slopes, the limit of large g")}},
      {"fs",
       {tier(FsForm::printed, FsForm::printed, "as published; not reciprocal"),
        tier(FsForm::reciprocal, FsForm::printed, "tan²theta_f averaged over both orders of the directions")}},
  };
}

std::vector<ParameterEntry> parameter_catalogue() {
  return {
      {.name = "slope",
       .unit = "",
       .scope = "shared",
       .min = slope_min,
       .max = slope_max,
       .meaning = "sigma / tau; the Beckmann roughness is twice that"},
      {.name = "sigma_um",
       .unit = "um",
       .scope = "shared",
       .min = sigma_um_min,
       .max = sigma_um_max,
       .meaning = "RMS height; known through coh or a fixed value only"},
      {.name = "tau_um",
       .unit = "um",
       .scope = "shared",
       .min = 0.0,
       .meaning = "correlation length, sigma / slope; known where sigma is"},
      coefficient(Coefficient::k_dd, 1.0, "of coh and dd"),
      coefficient(Coefficient::k_udf, 1.0, "of udf"),
      coefficient(Coefficient::k_uds, 1.0, "of uds"),
      coefficient(Coefficient::k_fs, std::numeric_limits<double>::infinity(), "of fs"),
      {.name = "n",
       .unit = "",
       .scope = "channel",
       .min = n_min,
       .max = n_max,
       .meaning = "refractive index; given, or free with --free n"},
      {.name = "kappa", .unit = "", .scope = "channel", .min = 0.0, .meaning = "absorption index; given"},
      {.name = "f0",
       .unit = "",
       .scope = "channel",
       .min = 0.0,
       .max = 1.0,
       .meaning = "normal reflectance in place of n and kappa; given, or free with --free f0"},
  };
}

}  // namespace goniofit::cli
