#include "fit/fit_spread.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

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

// Whether the moved material is one.
bool is_valid(const Material& moved) {
  try {
    validate(moved, moved.name);
  } catch (const Error&) {
    return false;
  }
  return true;
}

std::set<std::string> channel_names(const Material& material) {
  std::set<std::string> names;
  for (const auto& [channel, by_name] : material.fit->channel_uncertainty) {
    for (const auto& [name, by] : by_name) names.insert(name);
  }
  return names;
}

// A material's values at the readings of the problem that it was fitted to, by the fit's own columns.
class ColumnValues {
 public:
  ColumnValues(const Problem& problem, Model& model, const Eigen::VectorXd& shape)
      : problem_(problem), model_(model), shape_(shape) {}

  [[nodiscard]] const Eigen::VectorXd& of(const Material& m, std::size_t channel) {
    const MaterialChannel& from = m.channels[channel];
    const std::vector<BasisCoefficient>& coefficients = problem_.basis->coefficients();
    SmallVector k(static_cast<Eigen::Index>(coefficients.size()));
    for (std::size_t j = 0; j < coefficients.size(); ++j) {
      const BasisCoefficient& c = coefficients[j];
      k[static_cast<Eigen::Index>(j)] = c.constant() ? c.lower : from.coefficient(c.name).value_or(0.0);
    }
    if (problem_.free_optics == FreeOptics::n) model_.set_optics(channel, *from.n);
    if (problem_.free_optics == FreeOptics::f0) model_.set_optics(channel, *from.f0);
    model_.weighted_values(channel, k, values_);
    values_ = values_.cwiseQuotient(problem_.weight).cwiseMax(0.0).cwiseMin(saturation);
    return values_;
  }
  // Its shape, one parameter of it elsewhere; empty where it has none of that name.
  [[nodiscard]] Eigen::VectorXd shape_with(const std::string& name, double by) const {
    const std::optional<std::size_t> at = problem_.shape_index(name);
    if (!at) return {};
    Eigen::VectorXd out = shape_;
    double& z = out[static_cast<Eigen::Index>(*at)];
    z = std::log(std::exp(z) + by);
    return out;
  }
  void set(const Eigen::VectorXd& shape) { model_.set_whole_shape(shape, false); }
  [[nodiscard]] const Eigen::VectorXd& shape() const noexcept { return shape_; }

 private:
  const Problem& problem_;
  Model& model_;
  Eigen::VectorXd shape_, values_;
};

// Where a material is moved to, one parameter after the other by its standard uncertainty.
struct Moves {
  std::vector<Material> channels;  // a coefficient, or the optics, of every channel
  std::vector<std::pair<std::string, double>> shared;
};

Moves moves_of(const Material& material) {
  Moves out;
  for (const std::string& name : channel_names(material)) {
    Material moved = moved_channels(material, name);
    if (is_valid(moved)) out.channels.push_back(std::move(moved));
  }
  for (const auto& [name, by] : material.fit->shared_uncertainty) {
    if (is_valid(moved_shared(material, name, by))) out.shared.emplace_back(name, by);
  }
  return out;
}

Eigen::Map<Eigen::ArrayXd> readings_of(std::vector<double>& all, std::size_t first, const Problem& part) {
  return {all.data() + first, static_cast<Eigen::Index>(part.readings())};
}

// Of a problem in one piece, or a part whose readings start at `first`.
void fill_values(const Problem& part, ColumnValues values, const Material& material, const Moves& moves,
                 std::size_t first, FittedValues& out) {
  const std::size_t channels = part.channels.size();
  const auto n = static_cast<Eigen::Index>(part.readings());
  const auto add_squares = [&](const Material& there, std::size_t c) {
    const auto fitted = readings_of(out.fitted[c], first, part);
    readings_of(out.open[c], first, part) += (values.of(there, c).head(n).array() - fitted).square();
  };
  values.set(values.shape());
  for (std::size_t c = 0; c < channels; ++c)
    readings_of(out.fitted[c], first, part) = values.of(material, c).head(n).array();
  for (const Material& moved : moves.channels) {
    for (std::size_t c = 0; c < channels; ++c) add_squares(moved, c);
  }
  for (const auto& [name, by] : moves.shared) {
    const Eigen::VectorXd shape = values.shape_with(name, by);
    if (shape.size() == 0) continue;
    values.set(shape);
    for (std::size_t c = 0; c < channels; ++c) add_squares(material, c);
  }
  for (std::size_t c = 0; c < channels; ++c) {
    auto open = readings_of(out.open[c], first, part);
    open = open.sqrt();
  }
}

bool says_all(const Problem& problem, const Material& material) {
  if (material.components != problem.components || !material.fit) return false;
  if (material.components.has(Effect::rough) && material.forms.rough == RoughForm::functional) return false;
  const std::vector<ShapeParameter>& shape = problem.basis->shape_parameters();
  return std::all_of(shape.begin(), shape.end(), [&](const ShapeParameter& p) {
    if (material.model != surface_model) {
      const auto found = material.parameters.find(p.name);
      return found != material.parameters.end() && found->second.has_value();
    }
    return Surface(material.surface).find(p.name)->has_value();
  });
}

}  // namespace

std::optional<FittedValues> fitted_values(const Problem& problem, Model& model, const FitPoint& point,
                                          const Material& material) {
  if (!says_all(problem, material)) return std::nullopt;
  FittedValues out{.pairs = problem.by_parts() ? nullptr : &problem.pairs};
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    out.fitted.emplace_back(problem.readings());
    out.open.emplace_back(problem.readings(), 0.0);
  }
  const Moves moves = moves_of(material);
  const Eigen::VectorXd shape = problem.shape.at(point.z.data());
  if (!problem.by_parts()) {
    fill_values(problem, ColumnValues(problem, model, shape), material, moves, 0, out);
    return out;
  }
  std::size_t first = 0;
  problem.for_each_part([&](const Problem& part) {
    Model own(part);
    fill_values(part, ColumnValues(part, own, shape), material, moves, first, out);
    first += part.readings();
  });
  return out;
}

std::vector<double> value_uncertainties(const Material& material, const PairBatch& pairs,
                                        const std::vector<double>& values) {
  std::vector<double> u(values.size(), 0.0);
  if (!material.fit) return u;
  for (const auto& [name, by] : material.fit->shared_uncertainty) {
    add_change(moved_shared(material, name, by), pairs, values, u);
  }
  for (const std::string& name : channel_names(material)) {
    add_change(moved_channels(material, name), pairs, values, u);
  }
  for (double& variance : u) variance = std::sqrt(variance);
  return u;
}

}  // namespace goniofit
