// Whatever a material holds is read back as it was written, to the last bit.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "basis/basis.h"
#include "io/material_io.h"
#include "peers/peers.h"

namespace goniofit {

namespace {

double any_number(double low, double high) {
  const auto bits = *rc::gen::arbitrary<std::uint32_t>();
  return low + (high - low) * (static_cast<double>(bits) / 4294967296.0);
}

std::optional<double> maybe(double low, double high) {
  if (*rc::gen::arbitrary<bool>()) return std::nullopt;
  return any_number(low, high);
}

MaterialChannel any_channel(const std::string& name, bool with_f0) {
  MaterialChannel channel;
  channel.name = name;
  channel.wavelength_um = any_number(0.3, 12.0);
  if (with_f0) {
    channel.f0 = any_number(0.0, 1.0);
  } else {
    channel.n = any_number(0.01, 5.0);
    channel.kappa = maybe(0.0, 10.0);
  }
  return channel;
}

std::string any_name() {
  std::string name = *rc::gen::string<std::string>();
  for (char& c : name) c = static_cast<char>(c & 0x7f);  // any ASCII, controls and quotes included
  return name;
}

template <class E>
E any_of(std::initializer_list<E> values) {
  return *rc::gen::elementOf(std::vector<E>(values));
}

Surface any_surface() {
  Surface s;
  s.sigma_um = any_number(0.01, 2.0);
  s.tau_um = maybe(1.0, 30.0);
  s.slope = s.tau_um ? *s.sigma_um / *s.tau_um : any_number(1e-4, 1.0);
  if (*rc::gen::arbitrary<bool>()) {
    s.tau_y_um = maybe(1.0, 30.0);
    s.slope_y = s.tau_y_um ? *s.sigma_um / *s.tau_y_um : any_number(1e-4, 1.0);
  }
  s.tail = any_number(1.6, 50.0);
  s.facet_slope_deg = any_number(0.0, 80.0);
  return s;
}

Material any_surface_material() {
  Material m;
  for (int i = 0; i < 3; ++i)
    m.components.insert(*rc::gen::elementOf(std::vector<Effect>(all_effects.begin(), all_effects.end())));
  m.terms.fresnel = any_of({FresnelTier::schlick, FresnelTier::exact, FresnelTier::none});
  m.terms.shadowing =
      any_of({ShadowingTier::li_torrance, ShadowingTier::smith, ShadowingTier::schlick, ShadowingTier::none});
  m.terms.effective_roughness =
      any_of({EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::he, EffectiveRoughnessTier::none});
  m.terms.distribution = any_of({DistributionTier::rough_limit, DistributionTier::he_torrance,
                                 DistributionTier::he_torrance_series, DistributionTier::student_t});
  m.forms.fs = any_of({FsForm::printed, FsForm::reciprocal});
  m.forms.rough = any_of({RoughForm::integral, RoughForm::functional, RoughForm::qualitative});
  m.forms.anisotropy = any_of({AnisotropyForm::consistent, AnisotropyForm::printed});
  m.surface = any_surface();
  return m;
}

// Of any peer, its coefficients given or not.
Material any_peer_material() {
  Material m;
  m.model = std::string(peer_catalogue()[*rc::gen::inRange<std::size_t>(0, peer_catalogue().size())].name);
  m.terms.fresnel = any_of({FresnelTier::schlick, FresnelTier::exact, FresnelTier::none});
  const auto basis = make_peer(m.model);
  for (const ShapeParameter& p : basis->shape_parameters()) {
    m.parameters[p.name] = any_number(p.lower, p.upper);
  }
  return m;
}

void give_coefficients(const Material& m, MaterialChannel& channel) {
  if (m.model == surface_model) {
    for (const Coefficient c : all_coefficients) channel.coefficient(c) = maybe(0.0, 3.0);
    return;
  }
  const auto basis = make_peer(m.model);
  for (const BasisCoefficient& c : basis->coefficients()) {
    if (!c.constant() && *rc::gen::arbitrary<bool>()) channel.peer_k[c.name] = maybe(0.0, 3.0);
  }
}

// Every shared parameter and every coefficient that the material has.
FitSummary any_fit(const Material& m) {
  FitSummary fit;
  fit.loss = any_number(0.0, 1e9);
  fit.rms = any_number(0.0, 1e-9);
  fit.samples = *rc::gen::arbitrary<std::uint32_t>();
  fit.converged = *rc::gen::arbitrary<bool>();
  const auto share = [&](const std::string& name) {
    fit.shared_uncertainty[name] = any_number(0.0, 1e-3);
    fit.identifiable[name] = *rc::gen::arbitrary<bool>();
  };
  if (m.model == surface_model) {
    for (const std::string_view name : surface_parameter_names) share(std::string(name));
  }
  for (const auto& [name, value] : m.parameters) share(name);
  for (const MaterialChannel& channel : m.channels) {
    std::vector<std::string> names{"n"};
    for (const auto& [name, value] : channel.peer_k) names.push_back(name);
    if (m.model == surface_model) names.insert(names.end(), {"k_dd", "rho"});
    for (const std::string& name : names) {
      fit.channel_uncertainty[channel.name][name] = any_number(0.0, 1.0);
      fit.identifiable[channel.name + "." + name] = *rc::gen::arbitrary<bool>();
    }
  }
  return fit;
}

Material any_material() {
  Material m = *rc::gen::arbitrary<bool>() ? any_surface_material() : any_peer_material();
  m.name = any_name();
  m.solid_angle_sr = any_number(1e-6, 1e-2);
  const bool with_f0 = m.terms.fresnel != FresnelTier::exact && *rc::gen::arbitrary<bool>();
  const int channels = *rc::gen::inRange(1, 5);
  for (int i = 0; i < channels; ++i) {
    m.channels.push_back(any_channel("c/" + std::to_string(i) + ".~\"", with_f0));
    give_coefficients(m, m.channels.back());
  }
  if (*rc::gen::arbitrary<bool>()) m.fit = any_fit(m);
  return m;
}

RC_GTEST_PROP(MaterialIo, RoundTripIsExact, ()) {
  const Material m = any_material();
  const std::string text = to_json(m);
  const Material back = parse_material(text, "m.json");
  RC_ASSERT(back == m);
  RC_ASSERT(to_json(back) == text);
}

}  // namespace
}  // namespace goniofit
