#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "basis/basis.h"
#include "brdf/material.h"
#include "geometry/angles.h"
#include "peers/peers.h"
#include "support/error.h"
#include "support/text.h"
#include "terms/student_t_shadowing.h"

namespace goniofit {

namespace {

// What of a material's surface and channels an effect reads.
struct Needs {
  Effect effect;
  bool surface, fresnel;
};
constexpr std::array effect_needs{Needs{Effect::coh, true, true},   Needs{Effect::dd, true, true},
                                  Needs{Effect::udf, false, false}, Needs{Effect::uds, false, true},
                                  Needs{Effect::fs, true, true},    Needs{Effect::rough, false, false}};

// The names beside the coefficients that stand where a channel's name could.
constexpr std::array<std::string_view, 3> optical_parameters{"n", "kappa", "f0"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class Checker {
 public:
  Checker(const Material& material, const std::string& where) : material_(material), where_(where) {}

  void check() const {
    if (material_.model == surface_model) {
      if (material_.components.empty()) {
        fail("/components", "no effect is named, expected at least one of " + names_of<Effect>());
      }
      check_surface();
    } else {
      check_peer();
    }
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

  void check_slope(const std::optional<double>& slope, const std::string& pointer) const {
    if (!slope) return;
    require(*slope >= smallest_slope && *slope <= largest_slope, pointer, *slope,
            "a number in [" + shortest(smallest_slope) + ", " + shortest(largest_slope) + "]");
  }

  void check_ratio(const std::optional<double>& slope, const std::optional<double>& tau, const std::string& pointer,
                   const std::string& tau_name) const {
    const Surface& s = material_.surface;
    if (!slope || !s.sigma_um || !tau) return;
    const double ratio = *s.sigma_um / *tau;
    require(std::fabs(*slope - ratio) <= 1e-6 * ratio, pointer, *slope,
            "sigma_um / " + tau_name + " = " + shortest(ratio) + " within 1e-6 of itself");
  }

  void check_surface() const {
    const Surface& s = material_.surface;
    check_slope(s.slope, "/surface/slope");
    check_slope(s.slope_y, "/surface/slope_y");
    require_length(s.sigma_um, "/surface/sigma_um");
    require_length(s.tau_um, "/surface/tau_um");
    require_length(s.tau_y_um, "/surface/tau_y_um");
    if (s.tau_y_um && !s.slope_y) fail("/surface/slope_y", "is not given though tau_y_um is, expected both");
    if (s.tail) {
      require(std::isfinite(*s.tail) && *s.tail > 1.0, "/surface/tail", *s.tail, "a finite number above 1");
    }
    if (s.facet_slope_deg) {
      require(*s.facet_slope_deg >= 0.0 && *s.facet_slope_deg <= largest_facet_slope_deg, "/surface/facet_slope_deg",
              *s.facet_slope_deg, "a number in [0, " + shortest(largest_facet_slope_deg) + "]");
    }
    check_ratio(s.slope, s.tau_um, "/surface/slope", "tau_um");
    check_ratio(s.slope_y, s.tau_y_um, "/surface/slope_y", "tau_y_um");
  }

  // The basis is the one list of a peer's parameters.
  void check_peer() const {
    const std::unique_ptr<const Basis> basis = make_peer(material_.model);
    if (!basis) fail("/model", in_quotes(material_.model) + " is no model, expected one that `goniofit models` names");
    if (!material_.components.empty()) {
      fail("/components", "are named though the model is " + material_.model + ", which has no effects");
    }
    for (const ShapeParameter& p : basis->shape_parameters()) {
      const std::string pointer = "/parameters/" + p.name;
      const auto found = material_.parameters.find(p.name);
      if (found == material_.parameters.end() || !found->second) {
        if (!has_lobe(*basis)) continue;
        fail(pointer, "is not given, expected a number: " + material_.model + " reads it");
      }
      require(*found->second >= p.lower && *found->second <= p.upper, pointer, *found->second,
              "a number in [" + shortest(p.lower) + ", " + shortest(p.upper) + "]");
    }
    for (const auto& [name, value] : material_.parameters) {
      if (!is_shape_parameter(*basis, name)) {
        fail("/parameters" + pointer_step(name), "is not a parameter of " + material_.model);
      }
    }
    for (std::size_t i = 0; i < material_.channels.size(); ++i) check_peer_channel(*basis, i);
  }

  // Whether any channel has a part that reads the shape: without it a fit leaves the shape undetermined.
  [[nodiscard]] bool has_lobe(const Basis& basis) const {
    return std::any_of(basis.columns().begin(), basis.columns().end(), [&](const BasisColumn& c) {
      const BasisCoefficient& k = basis.coefficients()[c.coefficient];
      return c.reads_shape && (k.constant() || std::any_of(material_.channels.begin(), material_.channels.end(),
                                                           [&](const MaterialChannel& channel) {
                                                             return channel.coefficient(k.name).value_or(0.0) != 0.0;
                                                           }));
    });
  }

  static bool is_shape_parameter(const Basis& basis, const std::string& name) {
    return std::any_of(basis.shape_parameters().begin(), basis.shape_parameters().end(),
                       [&](const ShapeParameter& p) { return p.name == name; });
  }

  void check_peer_channel(const Basis& basis, std::size_t i) const {
    const MaterialChannel& channel = material_.channels[i];
    const std::string pointer = "/channels/" + std::to_string(i);
    for (const auto& [name, value] : channel.peer_k) {
      const bool known = std::any_of(
          basis.coefficients().begin(), basis.coefficients().end(),
          [&, &coefficient = name](const BasisCoefficient& c) { return c.name == coefficient && !c.constant(); });
      if (!known) fail(pointer + pointer_step(name), "is not a coefficient of " + material_.model);
      require_at_least_zero(value, pointer + pointer_step(name));
    }
    const bool reads_optics = std::any_of(basis.columns().begin(), basis.columns().end(), [&](const BasisColumn& c) {
      const BasisCoefficient& k = basis.coefficients()[c.coefficient];
      return c.optics != OpticsFactor::one && (k.constant() || channel.coefficient(k.name).value_or(0.0) != 0.0);
    });
    if (reads_optics) check_index(channel, pointer, material_.model);
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
    if (contains(surface_parameter_names, name) || parse_name<Coefficient>(name) ||
        contains(optical_parameters, name) || material_.parameters.contains(name)) {
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

  void need(const std::optional<double>& value, const std::string& pointer, const std::string& reader) const {
    if (!value) fail(pointer, "is not given, expected a number: " + reader + " reads it");
  }

  void check_needs(const Needs& needs, const MaterialChannel& channel, const std::string& pointer) const {
    const std::string reader(name_of(needs.effect));
    const Surface& s = material_.surface;
    if (needs.surface) need(s.slope, "/surface/slope", reader);
    if (needs.effect == Effect::rough) need(s.facet_slope_deg, "/surface/facet_slope_deg", reader);
    const DistributionTier distribution = material_.terms.distribution;
    const bool student = distribution == DistributionTier::student_t;
    const bool smith = material_.terms.shadowing == ShadowingTier::smith;
    if (student && (needs.effect == Effect::dd || (needs.effect == Effect::coh && smith))) {
      need(s.tail, "/surface/tail", "distribution student-t");
      require(!smith || *s.tail > smallest_tail_with_smith, "/surface/tail", *s.tail,
              "a number above " + shortest(smallest_tail_with_smith) +
                  " with shadowing smith: a longer tail has no mean slope, and such a surface shadows itself entirely");
    }
    const bool wave =
        distribution == DistributionTier::he_torrance || distribution == DistributionTier::he_torrance_series;
    if (needs.effect == Effect::coh || (needs.effect == Effect::dd && wave)) {
      const std::string length_reader = needs.effect == Effect::coh ? reader : "distribution he-torrance";
      need(s.sigma_um, "/surface/sigma_um", length_reader);
      need(channel.wavelength_um, pointer + "/wavelength_um", length_reader);
    }
    if (needs.fresnel) check_index(channel, pointer, reader);
  }

  void check_index(const MaterialChannel& channel, const std::string& pointer, const std::string& reader) const {
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
      if (!is_shared(parameter)) fail_shared(pointer, "the object of a channel");
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
    if (is_shared(parameter)) return;
    const std::string pointer = "/fit/identifiable" + pointer_step(parameter);
    const std::size_t dot = parameter.rfind('.');  // the last: a channel's name may have one
    if (dot == std::string::npos || !has_channel(parameter.substr(0, dot))) {
      fail_shared(pointer, "CHANNEL.PARAMETER, such as R.k_dd");
    }
    check_channel_parameter(parameter.substr(dot + 1), pointer);
  }

  [[nodiscard]] bool is_shared(const std::string& name) const {
    if (material_.model != surface_model) return material_.parameters.contains(name);
    return contains(surface_parameter_names, name);
  }

  [[noreturn]] void fail_shared(const std::string& pointer, const std::string& alternative) const {
    std::vector<std::string_view> names;
    if (material_.model == surface_model) names.assign(surface_parameter_names.begin(), surface_parameter_names.end());
    for (const auto& [name, value] : material_.parameters) names.push_back(name);
    const std::string known = names.empty() ? "" : alternatives(names) + ", or ";
    fail(pointer, "is not a shared parameter, expected " + known + alternative);
  }

  void check_channel_parameter(const std::string& parameter, const std::string& pointer) const {
    std::vector<std::string_view> names;
    if (material_.model == surface_model) {
      for (const Coefficient c : all_coefficients) names.push_back(name_of(c));
    } else {
      for (const MaterialChannel& channel : material_.channels) {
        for (const auto& [name, value] : channel.peer_k) {
          if (!contains(names, name)) names.push_back(name);
        }
      }
    }
    names.push_back("n");
    names.push_back("f0");
    if (contains(names, parameter)) return;
    fail(pointer, "is not a parameter of a channel, expected " + alternatives(names));
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
