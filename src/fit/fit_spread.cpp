#include "fit/fit_spread.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "brdf/evaluator.h"
#include "support/error.h"

namespace goniofit {

namespace {

double uncertainty_of(const std::map<std::string, double>& by_name, const std::string& name) {
  const auto found = by_name.find(name);
  return found == by_name.end() ? 0.0 : found->second;
}

// sigma, tau and slopes remain each other's quotients; nothing follows a tau, which follows them.
void move_surface(Surface& s, const std::string& name, double by) {
  std::optional<double>* const value = s.find(name);
  if (value == nullptr || !*value || name == "tau_um" || name == "tau_y_um") return;
  **value += by;
  if (s.tau_um && s.sigma_um && s.slope) s.tau_um = *s.sigma_um / *s.slope;
  if (s.tau_y_um && s.sigma_um && s.slope_y) s.tau_y_um = *s.sigma_um / *s.slope_y;
}

void move_channel(MaterialChannel& c, const std::string& name, double by) {
  if (name == "n") {
    if (c.n) *c.n += by;
  } else if (name == "f0") {
    if (c.f0) *c.f0 += *c.f0 + by < 1.0 ? by : -std::min(by, *c.f0);
  } else {
    c.set_coefficient(name, c.coefficient(name).value_or(0.0) + by);
  }
}

Material moved_shared(Material m, const std::string& name, double by) {
  if (m.model == surface_model) {
    move_surface(m.surface, name, by);
  } else if (auto& value = m.parameters[name]; value) {
    *value += by;
  }
  return m;
}

// In every channel at once: none reads another's.
Material moved_channels(Material m, const std::string& name) {
  for (MaterialChannel& c : m.channels) {
    const auto found = m.fit->channel_uncertainty.find(c.name);
    if (found == m.fit->channel_uncertainty.end()) continue;
    if (const double u = uncertainty_of(found->second, name); u > 0.0) move_channel(c, name, u);
  }
  return m;
}

void add_change(const Material& moved, const PairBatch& pairs, const std::vector<double>& values,
                std::vector<double>& variance) {
  try {
    const std::vector<double> there = Evaluator(moved).values(pairs);
    for (std::size_t i = 0; i < values.size(); ++i) variance[i] += (there[i] - values[i]) * (there[i] - values[i]);
  } catch (const Error&) {
    // Moved out of its range, beyond which nothing is known of it.
  }
}

}  // namespace

std::vector<double> value_uncertainties(const Material& material, const PairBatch& pairs,
                                        const std::vector<double>& values) {
  std::vector<double> u(values.size(), 0.0);
  if (!material.fit) return u;
  for (const auto& [name, by] : material.fit->shared_uncertainty) {
    add_change(moved_shared(material, name, by), pairs, values, u);
  }
  std::set<std::string> names;
  for (const auto& [channel, by_name] : material.fit->channel_uncertainty) {
    for (const auto& [name, by] : by_name) names.insert(name);
  }
  for (const std::string& name : names) add_change(moved_channels(material, name), pairs, values, u);
  for (double& variance : u) variance = std::sqrt(variance);
  return u;
}

}  // namespace goniofit
