#include "cli/fit_flags.h"

#include <array>
#include <set>
#include <utility>

#include "basis/basis.h"
#include "brdf/named_terms.h"
#include "cli/number_arguments.h"
#include "fit/loss.h"
#include "io/recipe_optics.h"
#include "io/reflectance_reader.h"
#include "peers/peers.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

template <class E>
E parse_enum(const std::string& text, const std::string& flag) {
  const std::optional<E> value = parse_name<E>(text);
  if (!value) throw usage_error(flag + ": " + in_quotes(text) + ", expected " + names_of<E>());
  return *value;
}

std::optional<EffectSet> parse_components(const std::string& text) {
  if (text == "auto") return std::nullopt;
  EffectSet effects;
  for (const std::string& word : parse_words(text, "--components")) {
    const std::optional<Effect> effect = parse_name<Effect>(word);
    if (!effect) {
      throw usage_error("--components: " + in_quotes(word) + ", expected auto or some of " + names_of<Effect>());
    }
    effects.insert(*effect);
  }
  return effects;
}

// The flags of the surface family's terms and forms: what a peer has none of.
bool is_peer(const FitSettings& settings) { return settings.model != surface_model; }

void check_peer_flags(const FitFlags& flags, const FitSettings& settings) {
  const std::array given{std::pair{"--components", flags.components.has_value()},
                         std::pair{"--terms", flags.terms.has_value()},
                         std::pair{"--shadowing", flags.shadowing.has_value()},
                         std::pair{"--effective-roughness", flags.effective_roughness.has_value()},
                         std::pair{"--distribution", flags.distribution.has_value()},
                         std::pair{"--fs-form", flags.fs_form.has_value()},
                         std::pair{"--rough-form", flags.rough_form.has_value()},
                         std::pair{"--anisotropy", flags.anisotropy.has_value()},
                         std::pair{"--anisotropic", flags.anisotropic}};
  for (const auto& [flag, is_given] : given) {
    if (is_given) throw usage_error(std::string(flag) + ": the model " + settings.model + " has none of it");
  }
}

// What the recipe says of another model's effects, terms and forms goes with that model.
void apply_model(const FitFlags& flags, FitSettings& settings) {
  if (flags.model && *flags.model != settings.model) {
    if (*flags.model != surface_model && !make_peer(*flags.model)) {
      throw usage_error("--model: " + in_quotes(*flags.model) + ", expected one that `goniofit models` names");
    }
    settings.model = *flags.model;
    settings.components.reset();
    settings.terms = {.fresnel = settings.terms.fresnel};
    settings.forms = {};
    settings.anisotropic = false;
  }
  if (is_peer(settings)) check_peer_flags(flags, settings);
  if (flags.components) settings.components = parse_components(*flags.components);
}

void apply_terms(const FitFlags& flags, FitSettings& settings) {
  if (flags.terms) {
    const std::optional<Terms> named = named_terms(*flags.terms);
    if (!named) throw usage_error("--terms: " + in_quotes(*flags.terms) + ", expected li-torrance or he-torrance");
    settings.terms = *named;
  }
  Terms& terms = settings.terms;
  if (flags.fresnel) terms.fresnel = parse_enum<FresnelTier>(*flags.fresnel, "--fresnel");
  if (flags.shadowing) terms.shadowing = parse_enum<ShadowingTier>(*flags.shadowing, "--shadowing");
  if (flags.effective_roughness) {
    terms.effective_roughness = parse_enum<EffectiveRoughnessTier>(*flags.effective_roughness, "--effective-roughness");
  }
  if (flags.distribution) terms.distribution = parse_enum<DistributionTier>(*flags.distribution, "--distribution");
  if (flags.fs_form) settings.forms.fs = parse_enum<FsForm>(*flags.fs_form, "--fs-form");
  if (flags.rough_form) settings.forms.rough = parse_enum<RoughForm>(*flags.rough_form, "--rough-form");
  if (flags.anisotropy) settings.forms.anisotropy = parse_enum<AnisotropyForm>(*flags.anisotropy, "--anisotropy");
  if (flags.anisotropic) settings.anisotropic = true;
}

void apply_optics(const FitFlags& flags, const Recipe& recipe, const Scan& scan, FitSettings& settings) {
  if (flags.f0 && (flags.n || flags.kappa))
    throw usage_error("--f0: stands in place of --n and --kappa; give one or the other");
  if (flags.optical_constants && (flags.f0 || flags.n || flags.kappa)) {
    throw usage_error("--optical-constants: stands in place of --n, --kappa and --f0; give one or the other");
  }
  if (const auto constants = optical_constants_of(flags, recipe)) use_optical_constants(*constants, scan, settings);
  if (flags.n || flags.kappa) settings.f0.clear();
  if (flags.n) settings.n = parse_numbers(*flags.n, "--n");
  if (flags.kappa) settings.kappa = parse_numbers(*flags.kappa, "--kappa");
  if (flags.f0) {
    settings.n.clear();
    settings.kappa.clear();
    settings.f0 = parse_numbers(*flags.f0, "--f0");
  }
  if (!flags.free_optics) return;
  const std::string& free = *flags.free_optics;
  if (free != "n" && free != "f0" && free != "none") {
    throw usage_error("--free: " + in_quotes(free) + ", expected n, f0 or none");
  }
  settings.free_optics = free == "n" ? FreeOptics::n : free == "f0" ? FreeOptics::f0 : FreeOptics::none;
}

ParameterSetting parse_bounds(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || text == ":") {
    throw usage_error("--bound: " + in_quotes(text) +
                      ", expected NAME=MIN:MAX such as slope=0.01:0.5 (either may be left out)");
  }
  ParameterSetting setting;
  if (colon > 0) setting.min = parse_number(text.substr(0, colon), "--bound");
  if (colon + 1 < text.size()) setting.max = parse_number(text.substr(colon + 1), "--bound");
  return setting;
}

void apply_parameters(const FitFlags& flags, FitSettings& settings) {
  std::set<std::string> given;
  const auto once = [&given](const std::string& name, const std::string& flag) {
    if (!given.insert(name).second) throw usage_error(flag + ": " + in_quotes(name) + " is given twice");
  };
  for (const std::string& text : flags.fixed) {
    const auto [name, value] = parse_assignment(text, "--fix");
    once(name, "--fix");
    settings.parameters[name] = {.value = parse_number(value, "--fix"), .min = {}, .max = {}};
  }
  for (const std::string& text : flags.bounded) {
    const auto [name, bounds] = parse_assignment(text, "--bound");
    once(name, "--bound");
    settings.parameters[name] = parse_bounds(bounds);
  }
}

double parse_positive(const std::string& text, const std::string& flag) {
  const double value = parse_number(text, flag);
  if (value <= 0.0) throw usage_error(flag + ": " + in_quotes(text) + ", expected a number above 0");
  return value;
}

void apply_exclusions(const FitFlags& flags, ExclusionSettings& exclude) {
  if (flags.exclude_retro) exclude.retro_cone_deg = parse_positive(*flags.exclude_retro, "--exclude-retro");
  if (flags.exclude_saturated && *flags.exclude_saturated == "auto") {
    exclude.saturated = true;
  } else if (flags.exclude_saturated) {
    exclude.saturated_from = parse_positive(*flags.exclude_saturated, "--exclude-saturated");
  }
  if (flags.exclude_clamped) exclude.clamped = true;
}

void apply_loss(const FitFlags& flags, FitSettings& settings) {
  if (flags.loss) settings.loss = parse_enum<Loss>(*flags.loss, "--loss");
  if (flags.weight) settings.weight = parse_enum<Weight>(*flags.weight, "--weight");
  if (flags.robust) {
    settings.robust = parse_enum<RobustKernel>(*flags.robust, "--robust");
    settings.robust_scale.reset();
  }
  if (flags.robust_scale) settings.robust_scale = parse_positive(*flags.robust_scale, "--robust-scale");
  if (flags.max_theta) {
    settings.max_theta_deg = parse_number(*flags.max_theta, "--max-theta");
    if (settings.max_theta_deg <= 0.0 || settings.max_theta_deg > 90.0) {
      throw usage_error("--max-theta: " + in_quotes(*flags.max_theta) + ", expected degrees above 0 and at most 90");
    }
  }
  if (flags.solid_angle) {
    settings.solid_angle_sr = parse_number(*flags.solid_angle, "--solid-angle");
    if (*settings.solid_angle_sr <= 0.0) {
      throw usage_error("--solid-angle: " + in_quotes(*flags.solid_angle) + ", expected steradians above 0");
    }
  }
}

void apply_uncertainty(const FitFlags& flags, FitSettings& settings) {
  if (flags.uncertainty && !parse_uncertainty(*flags.uncertainty, settings.uncertainty)) {
    throw usage_error("--uncertainty: " + in_quotes(*flags.uncertainty) + ", expected " +
                      std::string(uncertainty_words));
  }
  if (!flags.scale_u) return;
  settings.scale_u = parse_number(*flags.scale_u, "--scale-u");
  if (!(*settings.scale_u >= 0.0) || *settings.scale_u > 1.0) {
    throw usage_error("--scale-u: " + in_quotes(*flags.scale_u) + ", expected a part of the readings from 0 to 1");
  }
}

}  // namespace

void add_model_flag(CLI::App& command, FitFlags& flags) {
  command
      .add_option("--model", flags.model,
                  "surface (default), a peer that `goniofit models` names, or auto: the simplest "
                  "model that the scan does not tell from the best")
      ->type_name("NAME")
      ->group("Model");
}

void add_fit_flags(CLI::App& command, FitFlags& flags) {
  const auto once = [&command](const std::string& name, auto& target, const std::string& help) {
    return command.add_option(name, target, help);
  };
  once("--components", flags.components, "effects to fit: auto, or some of coh,dd,udf,uds,fs,rough")
      ->type_name("LIST")
      ->group("Model");
  once("--terms", flags.terms, "all four terms at once: li-torrance or he-torrance")->type_name("SET")->group("Model");
  once("--fresnel", flags.fresnel, names_of<FresnelTier>())->type_name("TIER")->group("Model");
  once("--shadowing", flags.shadowing, names_of<ShadowingTier>())->type_name("TIER")->group("Model");
  once("--effective-roughness", flags.effective_roughness, names_of<EffectiveRoughnessTier>())
      ->type_name("TIER")
      ->group("Model");
  once("--distribution", flags.distribution, names_of<DistributionTier>())->type_name("TIER")->group("Model");
  once("--fs-form", flags.fs_form, "forward scattering: " + names_of<FsForm>())->type_name("FORM")->group("Model");
  once("--rough-form", flags.rough_form, "grooves: " + names_of<RoughForm>())->type_name("FORM")->group("Model");
  once("--anisotropy", flags.anisotropy, "how an anisotropic surface reads the azimuth: " + names_of<AnisotropyForm>())
      ->type_name("FORM")
      ->group("Model");
  command.add_flag("--anisotropic", flags.anisotropic, "two slopes, along and across")->group("Model");
  once("--n", flags.n, "refractive index, one or one a channel (1.7 or 1.7,1.6,1.6)")
      ->type_name("LIST")
      ->group("Optics");
  once("--kappa", flags.kappa, "absorption index, likewise")->type_name("LIST")->group("Optics");
  once("--f0", flags.f0, "normal reflectance, likewise, in place of n and kappa")->type_name("LIST")->group("Optics");
  once("--optical-constants", flags.optical_constants,
       "n and kappa against wavelength: CSV or refractiveindex.info YAML")
      ->type_name("FILE")
      ->group("Optics");
  once("--free", flags.free_optics, "fit the optical constants too: n, f0 or none")->type_name("WHAT")->group("Optics");
  once("--solid-angle", flags.solid_angle, "solid angle of the source, for coh")->type_name("SR")->group("Optics");
  once("--channels", flags.channels, "channels to fit (450nm,550nm or R,G)")->type_name("LIST")->group("Data");
  once("--max-theta", flags.max_theta, "leave out readings with an angle beyond this")->type_name("DEG")->group("Data");
  once("--exclude-retro", flags.exclude_retro, "leave out readings as near to the retro direction as this")
      ->type_name("DEG")
      ->group("Data");
  once("--exclude-saturated", flags.exclude_saturated,
       "leave out values from this on, or 'auto': a largest value that repeats")
      ->type_name("VALUE")
      ->group("Data");
  command.add_flag("--exclude-clamped", flags.exclude_clamped, "leave out values of exactly 0")->group("Data");
  once("--reflectances", flags.reflectances,
       "directional-hemispherical reflectances to fit beside the scan: CSV of theta_i and channels")
      ->type_name("FILE")
      ->group("Data");
  once("--fix", flags.fixed, "fix a parameter; may be repeated (k_fs=0, R.k_dd=0.5)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group("Parameters");
  once("--bound", flags.bounded, "bound a parameter; may be repeated (slope=0.01:0.5)")
      ->type_name("NAME=MIN:MAX")
      ->allow_extra_args(false)
      ->group("Parameters");
  once("--uncertainty", flags.uncertainty, "where standard uncertainties come from: " + std::string(uncertainty_words))
      ->type_name("SOURCE")
      ->group("Uncertainty");
  once("--scale-u", flags.scale_u, "relative standard uncertainty of the instrument's scale (0.01)")
      ->type_name("U")
      ->group("Uncertainty");
  once("--loss", flags.loss, names_of<Loss>() + " (default cosine-l2: the sum of cos(theta_i) |difference|²)")
      ->type_name("LOSS")
      ->group("Loss");
  once("--weight", flags.weight, "of a reading, on top of the loss: " + names_of<Weight>())
      ->type_name("WEIGHT")
      ->group("Loss");
  once("--robust", flags.robust, "large residuals count for less: " + names_of<RobustKernel>())
      ->type_name("KERNEL")
      ->group("Loss");
  once("--robust-scale", flags.robust_scale, "where the kernel sets in, instead of an estimate from the residuals")
      ->type_name("SIZE")
      ->group("Loss");
}

std::vector<std::string> channels_of(const FitFlags& flags, const Recipe& recipe) {
  return flags.channels ? parse_words(*flags.channels, "--channels") : recipe.channels;
}

std::optional<std::filesystem::path> reflectances_of(const FitFlags& flags, const Recipe& recipe) {
  return flags.reflectances ? flags.reflectances : recipe.reflectances;
}

std::optional<std::filesystem::path> optical_constants_of(const FitFlags& flags, const Recipe& recipe) {
  if (flags.optical_constants) return flags.optical_constants;
  // A flag wins over the recipe, whichever way either of them gives the constants.
  if (flags.n || flags.kappa || flags.f0) return std::nullopt;
  return recipe.optical_constants;
}

FitSettings settings_of(const FitFlags& flags, const Recipe& recipe, const Scan& scan) {
  FitSettings settings = recipe.settings;
  apply_model(flags, settings);
  apply_terms(flags, settings);
  apply_optics(flags, recipe, scan, settings);
  apply_parameters(flags, settings);
  apply_loss(flags, settings);
  apply_exclusions(flags, settings.exclusions);
  if (const auto file = reflectances_of(flags, recipe)) settings.reflectances = read_reflectances(*file);
  apply_uncertainty(flags, settings);
  return settings;
}

}  // namespace goniofit::cli
