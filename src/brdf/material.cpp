#include "brdf/material.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "geometry/angles.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

template <class E>
struct Named {
  E value;
  std::string_view name;
};

constexpr std::array effect_names{Named<Effect>{Effect::coh, "coh"}, Named<Effect>{Effect::dd, "dd"},
                                  Named<Effect>{Effect::udf, "udf"}, Named<Effect>{Effect::uds, "uds"},
                                  Named<Effect>{Effect::fs, "fs"}};
constexpr std::array coefficient_names{
    Named<Coefficient>{Coefficient::k_dd, "k_dd"}, Named<Coefficient>{Coefficient::k_udf, "k_udf"},
    Named<Coefficient>{Coefficient::k_uds, "k_uds"}, Named<Coefficient>{Coefficient::k_fs, "k_fs"}};
constexpr std::array fresnel_names{Named<FresnelTier>{FresnelTier::schlick, "schlick"},
                                   Named<FresnelTier>{FresnelTier::exact, "exact"},
                                   Named<FresnelTier>{FresnelTier::none, "none"}};
constexpr std::array shadowing_names{Named<ShadowingTier>{ShadowingTier::li_torrance, "li-torrance"},
                                     Named<ShadowingTier>{ShadowingTier::none, "none"}};
constexpr std::array roughness_names{Named<EffectiveRoughnessTier>{EffectiveRoughnessTier::li_torrance, "li-torrance"},
                                     Named<EffectiveRoughnessTier>{EffectiveRoughnessTier::none, "none"}};
constexpr std::array distribution_names{Named<DistributionTier>{DistributionTier::rough_limit, "rough-limit"}};
constexpr std::array fs_form_names{Named<FsForm>{FsForm::printed, "printed"},
                                   Named<FsForm>{FsForm::reciprocal, "reciprocal"}};

// The argument only chooses the table.
constexpr std::span<const Named<Effect>> names(Effect) { return effect_names; }
constexpr std::span<const Named<Coefficient>> names(Coefficient) { return coefficient_names; }
constexpr std::span<const Named<FresnelTier>> names(FresnelTier) { return fresnel_names; }
constexpr std::span<const Named<ShadowingTier>> names(ShadowingTier) { return shadowing_names; }
constexpr std::span<const Named<EffectiveRoughnessTier>> names(EffectiveRoughnessTier) { return roughness_names; }
constexpr std::span<const Named<DistributionTier>> names(DistributionTier) { return distribution_names; }
constexpr std::span<const Named<FsForm>> names(FsForm) { return fs_form_names; }

template <class E>
std::string_view find_name(E value) noexcept {
  for (const Named<E>& entry : names(value)) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

}  // namespace

std::string_view name_of(Effect e) noexcept { return find_name(e); }
std::string_view name_of(Coefficient c) noexcept { return find_name(c); }
std::string_view name_of(FresnelTier t) noexcept { return find_name(t); }
std::string_view name_of(ShadowingTier t) noexcept { return find_name(t); }
std::string_view name_of(EffectiveRoughnessTier t) noexcept { return find_name(t); }
std::string_view name_of(DistributionTier t) noexcept { return find_name(t); }
std::string_view name_of(FsForm f) noexcept { return find_name(f); }

template <class E>
std::optional<E> parse_name(std::string_view name) noexcept {
  for (const Named<E>& entry : names(E{})) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

template <class E>
std::string names_of() {
  std::vector<std::string_view> all;
  for (const Named<E>& entry : names(E{})) all.push_back(entry.name);
  return alternatives(all);
}

template std::optional<Effect> parse_name(std::string_view) noexcept;
template std::optional<Coefficient> parse_name(std::string_view) noexcept;
template std::optional<FresnelTier> parse_name(std::string_view) noexcept;
template std::optional<ShadowingTier> parse_name(std::string_view) noexcept;
template std::optional<EffectiveRoughnessTier> parse_name(std::string_view) noexcept;
template std::optional<DistributionTier> parse_name(std::string_view) noexcept;
template std::optional<FsForm> parse_name(std::string_view) noexcept;
template std::string names_of<Effect>();
template std::string names_of<Coefficient>();
template std::string names_of<FresnelTier>();
template std::string names_of<ShadowingTier>();
template std::string names_of<EffectiveRoughnessTier>();
template std::string names_of<DistributionTier>();
template std::string names_of<FsForm>();

Coefficient coefficient_of(Effect effect) noexcept {
  switch (effect) {
    case Effect::udf:
      return Coefficient::k_udf;
    case Effect::uds:
      return Coefficient::k_uds;
    case Effect::fs:
      return Coefficient::k_fs;
    case Effect::coh:
    case Effect::dd:
      break;
  }
  return Coefficient::k_dd;
}

double MaterialChannel::normal_reflectance() const noexcept {
  if (f0) return *f0;
  if (!n) return 0.0;
  const double absorption = kappa.value_or(0.0);
  // hypot: n and kappa of 1e200 have a reflectance, though their squares are infinite.
  const double ratio = std::hypot(*n - 1.0, absorption) / std::hypot(*n + 1.0, absorption);
  return ratio * ratio;
}

namespace {

// What of a material's surface and channels an effect reads.
struct Needs {
  Effect effect;
  bool slope, fresnel, wavelength;
};
constexpr std::array effect_needs{Needs{Effect::coh, true, true, true}, Needs{Effect::dd, true, true, false},
                                  Needs{Effect::udf, false, false, false}, Needs{Effect::uds, false, true, false},
                                  Needs{Effect::fs, true, true, false}};

// What a fit can say something of, and the one name beside them that stands where a channel's name could.
constexpr std::array<std::string_view, 3> shared_parameters{"slope", "sigma_um", "tau_um"};
constexpr std::array<std::string_view, 6> channel_parameters{"k_dd", "k_udf", "k_uds", "k_fs", "n", "f0"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class Checker {
 public:
  Checker(const Material& material, const std::string& where) : material_(material), where_(where) {}

  void check() const {
    if (material_.components.empty()) {
      fail("/components", "no effect is named, expected at least one of " + names_of<Effect>());
    }
    check_surface();
    require(material_.solid_angle_sr > 0.0 && material_.solid_angle_sr < 2.0 * pi, "/solid_angle_sr",
            material_.solid_angle_sr, "a number above 0 and below 2 pi");
    check_channels();
    if (material_.fit) check_fit(*material_.fit);
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    throw where_.empty() ? usage_error(pointer + ": " + what) : key_error(where_, pointer, what);
  }

  void require(bool holds, const std::string& pointer, double value, const std::string& expected) const {
    if (!holds) fail(pointer, "is " + shortest(value) + ", expected " + expected);
  }

  void require_length(const std::optional<double>& value, const std::string& pointer) const {
    if (value) require(std::isfinite(*value) && *value > 0.0, pointer, *value, "a finite number above 0");
  }

  void require_at_least_zero(const std::optional<double>& value, const std::string& pointer) const {
    if (value) require(std::isfinite(*value) && *value >= 0.0, pointer, *value, "a finite number of at least 0");
  }

  // An effect acts on a channel where it is among the components and its coefficient is not 0 (null counts as 0).
  [[nodiscard]] bool acts(Effect effect, const MaterialChannel& channel) const {
    return material_.components.has(effect) && channel.coefficient(coefficient_of(effect)).value_or(0.0) != 0.0;
  }

  void check_surface() const {
    const Surface& s = material_.surface;
    if (s.slope) {
      require(*s.slope >= smallest_slope && *s.slope <= largest_slope, "/surface/slope", *s.slope,
              "a number in [" + shortest(smallest_slope) + ", " + shortest(largest_slope) + "]");
    }
    require_length(s.sigma_um, "/surface/sigma_um");
    require_length(s.tau_um, "/surface/tau_um");
    if (!s.slope || !s.sigma_um || !s.tau_um) return;
    const double ratio = *s.sigma_um / *s.tau_um;
    require(std::fabs(*s.slope - ratio) <= 1e-6 * ratio, "/surface/slope", *s.slope,
            "sigma_um / tau_um = " + shortest(ratio) + " within 1e-6 of itself");
  }

  void check_channels() const {
    if (material_.channels.empty()) fail("/channels", "has no channel, expected at least one");
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < material_.channels.size(); ++i) {
      const MaterialChannel& channel = material_.channels[i];
      const std::string pointer = "/channels/" + std::to_string(i);
      check_name(channel.name, pointer + "/name");
      if (!seen.insert(channel.name).second) {
        fail(pointer + "/name", "there is another channel " + in_quotes(channel.name) + ", expected different names");
      }
      check_optics(channel, pointer);
      for (const Coefficient c : all_coefficients) {
        require_at_least_zero(channel.coefficient(c), pointer + "/" + std::string(name_of(c)));
      }
      for (const Needs& needs : effect_needs) {
        if (acts(needs.effect, channel)) check_needs(needs, channel, pointer);
      }
    }
  }

  void check_name(const std::string& name, const std::string& pointer) const {
    if (name.empty()) fail(pointer, "is empty, expected the channel's name");
    for (const char c : name) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) fail(pointer, "has a control character, expected none");
    }
    // Files have parameters and channels side by side.
    if (contains(shared_parameters, name) || contains(channel_parameters, name) || name == "kappa") {
      fail(pointer, in_quotes(name) + " is the name of a parameter, expected another name");
    }
  }

  void check_optics(const MaterialChannel& channel, const std::string& pointer) const {
    require_length(channel.wavelength_um, pointer + "/wavelength_um");
    require_length(channel.n, pointer + "/n");
    require_at_least_zero(channel.kappa, pointer + "/kappa");
    if (channel.f0) {
      require(*channel.f0 >= 0.0 && *channel.f0 <= 1.0, pointer + "/f0", *channel.f0, "a number in [0, 1]");
      if (channel.n || channel.kappa) fail(pointer + "/f0", "stands beside n or kappa, expected it in their place");
    }
    if (channel.kappa && !channel.n) fail(pointer + "/n", "is not given though kappa is, expected both");
  }

  void check_needs(const Needs& needs, const MaterialChannel& channel, const std::string& pointer) const {
    const std::string reader(name_of(needs.effect));
    if (needs.slope && !material_.surface.slope) {
      fail("/surface/slope", "is not given, expected a number: " + reader + " reads it");
    }
    if (needs.wavelength && !material_.surface.sigma_um) {
      fail("/surface/sigma_um", "is not given, expected a number: " + reader + " reads it");
    }
    if (needs.wavelength && !channel.wavelength_um) {
      fail(pointer + "/wavelength_um", "is not given, expected a number: " + reader + " reads it");
    }
    if (!needs.fresnel) return;
    if (material_.terms.fresnel == FresnelTier::exact && !channel.n) {
      fail(pointer + "/n",
           "is not given, expected a number: fresnel exact needs n and kappa, f0 does not replace them");
    }
    if (material_.terms.fresnel == FresnelTier::schlick && !channel.n && !channel.f0) {
      fail(pointer + "/n", "is not given, expected n (and kappa) or f0: " + reader + " reads it");
    }
  }

  void check_fit(const FitSummary& fit) const {
    require_at_least_zero(fit.loss, "/fit/loss");
    require_at_least_zero(fit.rms, "/fit/rms");
    const std::string uncertainty = "/fit/uncertainty";
    for (const auto& [parameter, u] : fit.shared_uncertainty) {
      const std::string pointer = uncertainty + pointer_step(parameter);
      if (!contains(shared_parameters, parameter)) fail_shared(pointer, "the object of a channel");
      require_at_least_zero(u, pointer);
    }
    for (const auto& [channel, by_parameter] : fit.channel_uncertainty) {
      if (!has_channel(channel)) fail(uncertainty + pointer_step(channel), "is not a channel of this material");
      for (const auto& [parameter, u] : by_parameter) {
        const std::string pointer = uncertainty + pointer_step(channel) + pointer_step(parameter);
        check_channel_parameter(parameter, pointer);
        require_at_least_zero(u, pointer);
      }
    }
    for (const auto& [parameter, known] : fit.identifiable) check_identifiable(parameter);
  }

  // "slope" or "R.k_fs".
  void check_identifiable(const std::string& parameter) const {
    if (contains(shared_parameters, parameter)) return;
    const std::string pointer = "/fit/identifiable" + pointer_step(parameter);
    const std::size_t dot = parameter.rfind('.');  // the last: a channel's name may have one
    if (dot == std::string::npos || !has_channel(parameter.substr(0, dot))) {
      fail_shared(pointer, "CHANNEL.PARAMETER, such as R.k_dd");
    }
    check_channel_parameter(parameter.substr(dot + 1), pointer);
  }

  [[noreturn]] void fail_shared(const std::string& pointer, const std::string& alternative) const {
    fail(pointer, "is not a shared parameter, expected " + alternatives(shared_parameters) + ", or " + alternative);
  }

  void check_channel_parameter(const std::string& parameter, const std::string& pointer) const {
    if (contains(channel_parameters, parameter)) return;
    fail(pointer, "is not a parameter of a channel, expected " + alternatives(channel_parameters));
  }

  [[nodiscard]] bool has_channel(const std::string& name) const {
    return std::any_of(material_.channels.begin(), material_.channels.end(),
                       [&](const MaterialChannel& channel) { return channel.name == name; });
  }

  const Material& material_;
  const std::string& where_;
};

}  // namespace

void validate(const Material& material, const std::string& where) { Checker(material, where).check(); }

}  // namespace goniofit
