// Which sets of effects are worth a fit.

#include <algorithm>
#include <cmath>

#include "brdf/surface_shape.h"
#include "fit/parameter_settings.h"
#include "fit/problem.h"
#include "fit/selection.h"

namespace goniofit {

namespace {

// Whether T(cos_i) T(cos_r) is far enough from a constant that udf and uds are two effects: over the readings it has to
// vary by 2 % of itself (Schlick's T of glass does so from the normal to 55 degrees).
bool transmission_varies(const Problem& problem) {
  constexpr double least = 0.02;
  for (const ProblemChannel& channel : problem.channels) {
    double sum = 0.0;
    double sum2 = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < problem.samples(); ++i) {
      const double w = problem.weight[static_cast<Eigen::Index>(i)] * problem.weight[static_cast<Eigen::Index>(i)];
      const double t = transmission(problem.terms.fresnel, channel.optics, problem.pairs[i]);
      weights += w;
      sum += w * t;
      sum2 += w * t * t;
    }
    if (sum2 * weights - sum * sum > least * least * sum * sum) return true;
  }
  return false;
}

bool sees_the_mirror(const Problem& problem) {
  const bool wavelengths = std::all_of(problem.channels.begin(), problem.channels.end(),
                                       [](const ProblemChannel& c) { return c.wavelength_um.has_value(); });
  for (std::size_t i = 0; wavelengths && i < problem.samples(); ++i) {
    if (in_mirror_cone(problem.pairs[i], problem.solid_angle_sr)) return true;
  }
  return false;
}

enum class Demand { none, in, out };

// What the settings say of an effect by fixing its coefficient.
Demand demand_of(Effect effect, const Problem& problem, const FitSettings& settings) {
  const std::string name(name_of(coefficient_of(effect)));
  bool out = true;
  bool in = false;
  for (const ProblemChannel& c : problem.channels) {
    const ParameterSetting s = setting_of(settings, name, c.name);
    out = out && (s.value == 0.0 || s.max == 0.0);
    in = in || s.value.value_or(0.0) > 0.0 || s.min.value_or(0.0) > 0.0;
  }
  return out ? Demand::out : in ? Demand::in : Demand::none;
}

}  // namespace

std::vector<EffectSet> sensible_components(const Scan& scan, const FitSettings& settings) {
  FitSettings flat = settings;
  flat.components = EffectSet{Effect::udf};
  flat.terms.distribution = DistributionTier::rough_limit;  // which asks for no wavelength yet
  for (const char* name : {"sigma_um", "tau_um"}) flat.parameters.erase(name);
  const Problem readings(scan, flat);
  const bool metal = std::any_of(readings.channels.begin(), readings.channels.end(),
                                 [](const ProblemChannel& c) { return c.optics.kappa > 0.0; });
  const bool mirror = sees_the_mirror(readings);
  const bool separable = transmission_varies(readings);
  const auto sensible = [&](EffectSet s) {
    const bool coh = s.has(Effect::coh), dd = s.has(Effect::dd), udf = s.has(Effect::udf), uds = s.has(Effect::uds),
               fs = s.has(Effect::fs), rough = s.has(Effect::rough);
    if (s.empty() || (coh && !(mirror && dd)) || (fs && !dd) || (metal && (uds || fs))) return false;
    if (rough && (udf || uds)) return false;
    if (!metal && !separable && udf) return false;
    for (const Effect e : {Effect::dd, Effect::udf, Effect::uds, Effect::fs, Effect::rough}) {
      const Demand demand = demand_of(e, readings, settings);
      if ((demand == Demand::in && !s.has(e)) || (demand == Demand::out && s.has(e))) return false;
    }
    return true;
  };
  std::vector<EffectSet> sets;
  for (unsigned bits = 0; bits < 1U << all_effects.size(); ++bits) {
    EffectSet set;
    for (std::size_t i = 0; i < all_effects.size(); ++i) {
      if ((bits >> i & 1U) != 0) set.insert(all_effects[i]);
    }
    if (sensible(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace goniofit
