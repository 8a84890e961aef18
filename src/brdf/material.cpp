#include "brdf/material.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/angles.h"
#include "support/error.h"
#include "support/named.h"

namespace goniofit {

namespace {

constexpr std::array effect_names{Named<Effect>{Effect::coh, "coh"}, Named<Effect>{Effect::dd, "dd"},
                                  Named<Effect>{Effect::udf, "udf"}, Named<Effect>{Effect::uds, "uds"},
                                  Named<Effect>{Effect::fs, "fs"},   Named<Effect>{Effect::rough, "rough"}};
constexpr std::array coefficient_names{
    Named<Coefficient>{Coefficient::k_dd, "k_dd"}, Named<Coefficient>{Coefficient::k_udf, "k_udf"},
    Named<Coefficient>{Coefficient::k_uds, "k_uds"}, Named<Coefficient>{Coefficient::k_fs, "k_fs"},
    Named<Coefficient>{Coefficient::rho, "rho"}};
constexpr std::array fresnel_names{Named<FresnelTier>{FresnelTier::schlick, "schlick"},
                                   Named<FresnelTier>{FresnelTier::exact, "exact"},
                                   Named<FresnelTier>{FresnelTier::none, "none"}};
constexpr std::array shadowing_names{Named<ShadowingTier>{ShadowingTier::li_torrance, "li-torrance"},
                                     Named<ShadowingTier>{ShadowingTier::smith, "smith"},
                                     Named<ShadowingTier>{ShadowingTier::schlick, "schlick"},
                                     Named<ShadowingTier>{ShadowingTier::none, "none"}};
constexpr std::array roughness_names{Named<EffectiveRoughnessTier>{EffectiveRoughnessTier::li_torrance, "li-torrance"},
                                     Named<EffectiveRoughnessTier>{EffectiveRoughnessTier::he, "he"},
                                     Named<EffectiveRoughnessTier>{EffectiveRoughnessTier::none, "none"}};
constexpr std::array distribution_names{
    Named<DistributionTier>{DistributionTier::rough_limit, "rough-limit"},
    Named<DistributionTier>{DistributionTier::he_torrance, "he-torrance"},
    Named<DistributionTier>{DistributionTier::he_torrance_series, "he-torrance-series"},
    Named<DistributionTier>{DistributionTier::student_t, "student-t"}};
constexpr std::array fs_form_names{Named<FsForm>{FsForm::printed, "printed"},
                                   Named<FsForm>{FsForm::reciprocal, "reciprocal"}};
constexpr std::array rough_form_names{Named<RoughForm>{RoughForm::functional, "functional"},
                                      Named<RoughForm>{RoughForm::integral, "integral"},
                                      Named<RoughForm>{RoughForm::qualitative, "qualitative"}};
constexpr std::array anisotropy_form_names{Named<AnisotropyForm>{AnisotropyForm::consistent, "consistent"},
                                           Named<AnisotropyForm>{AnisotropyForm::printed, "printed"}};

// The argument only chooses the table.
constexpr std::span<const Named<Effect>> names(Effect) { return effect_names; }
constexpr std::span<const Named<Coefficient>> names(Coefficient) { return coefficient_names; }
constexpr std::span<const Named<FresnelTier>> names(FresnelTier) { return fresnel_names; }
constexpr std::span<const Named<ShadowingTier>> names(ShadowingTier) { return shadowing_names; }
constexpr std::span<const Named<EffectiveRoughnessTier>> names(EffectiveRoughnessTier) { return roughness_names; }
constexpr std::span<const Named<DistributionTier>> names(DistributionTier) { return distribution_names; }
constexpr std::span<const Named<FsForm>> names(FsForm) { return fs_form_names; }
constexpr std::span<const Named<RoughForm>> names(RoughForm) { return rough_form_names; }
constexpr std::span<const Named<AnisotropyForm>> names(AnisotropyForm) { return anisotropy_form_names; }

template <class E>
std::string_view find_name(E value) noexcept {
  return name_in(names(value), value);
}

}  // namespace

std::string_view name_of(Effect e) noexcept { return find_name(e); }
std::string_view name_of(Coefficient c) noexcept { return find_name(c); }
std::string_view name_of(FresnelTier t) noexcept { return find_name(t); }
std::string_view name_of(ShadowingTier t) noexcept { return find_name(t); }
std::string_view name_of(EffectiveRoughnessTier t) noexcept { return find_name(t); }
std::string_view name_of(DistributionTier t) noexcept { return find_name(t); }
std::string_view name_of(FsForm f) noexcept { return find_name(f); }
std::string_view name_of(RoughForm f) noexcept { return find_name(f); }
std::string_view name_of(AnisotropyForm f) noexcept { return find_name(f); }

template <class E>
std::optional<E> parse_name(std::string_view name) noexcept {
  return value_in(names(E{}), name);
}

template <class E>
std::string names_of() {
  return names_in(names(E{}));
}

template std::optional<Effect> parse_name(std::string_view) noexcept;
template std::optional<Coefficient> parse_name(std::string_view) noexcept;
template std::optional<FresnelTier> parse_name(std::string_view) noexcept;
template std::optional<ShadowingTier> parse_name(std::string_view) noexcept;
template std::optional<EffectiveRoughnessTier> parse_name(std::string_view) noexcept;
template std::optional<DistributionTier> parse_name(std::string_view) noexcept;
template std::optional<FsForm> parse_name(std::string_view) noexcept;
template std::optional<RoughForm> parse_name(std::string_view) noexcept;
template std::optional<AnisotropyForm> parse_name(std::string_view) noexcept;
template std::string names_of<Effect>();
template std::string names_of<Coefficient>();
template std::string names_of<FresnelTier>();
template std::string names_of<ShadowingTier>();
template std::string names_of<EffectiveRoughnessTier>();
template std::string names_of<DistributionTier>();
template std::string names_of<FsForm>();
template std::string names_of<RoughForm>();
template std::string names_of<AnisotropyForm>();

Coefficient coefficient_of(Effect effect) noexcept {
  switch (effect) {
    case Effect::udf:
      return Coefficient::k_udf;
    case Effect::uds:
      return Coefficient::k_uds;
    case Effect::fs:
      return Coefficient::k_fs;
    case Effect::rough:
      return Coefficient::rho;
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

std::optional<double>* Surface::find(std::string_view name) noexcept {
  const std::array members{&slope, &sigma_um, &tau_um, &slope_y, &tau_y_um, &tail, &facet_slope_deg};
  const auto at = std::find(surface_parameter_names.begin(), surface_parameter_names.end(), name);
  if (at == surface_parameter_names.end()) return nullptr;
  return members[static_cast<std::size_t>(at - surface_parameter_names.begin())];
}

std::optional<double> MaterialChannel::coefficient(std::string_view coefficient_name) const {
  if (const auto c = parse_name<Coefficient>(coefficient_name)) return coefficient(*c);
  const auto found = peer_k.find(std::string(coefficient_name));
  return found == peer_k.end() ? std::nullopt : found->second;
}

void MaterialChannel::set_coefficient(const std::string& coefficient_name, std::optional<double> value) {
  if (const auto c = parse_name<Coefficient>(coefficient_name)) {
    coefficient(*c) = value;
  } else {
    peer_k[coefficient_name] = value;
  }
}

}  // namespace goniofit
