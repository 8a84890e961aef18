#include "report/material_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "brdf/batch_evaluator.h"
#include "geometry/angles.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {
namespace {

template <class Map>
auto found_in(const Map& map, const std::string& key) {
  const auto found = map.find(key);
  return found == map.end() ? std::nullopt : std::optional(found->second);
}

std::string unit_of(std::string_view name) {
  if (name.ends_with("_um")) return "um";
  return name.ends_with("_deg") ? "deg" : "";
}

class Rows {
 public:
  explicit Rows(const Material& material) : material_(material), fit_(material.fit.value_or(FitSummary{})) {
    add_shape();
    for (const MaterialChannel& channel : material.channels) add_channel(channel);
  }
  [[nodiscard]] std::vector<FittedParameter> take() { return std::move(rows_); }

 private:
  void add_shape();
  void add_channel(const MaterialChannel& channel);
  void add(const std::string& channel, const std::string& name, const std::optional<double>& value, double lower);

  const Material& material_;
  FitSummary fit_;
  std::vector<FittedParameter> rows_;
};

void Rows::add(const std::string& channel, const std::string& name, const std::optional<double>& value, double lower) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const std::string key = channel.empty() ? name : channel + "." + name;
  FittedParameter p{.name = name, .channel = channel, .unit = unit_of(name), .value = value, .u = {}};
  p.lower = lower;
  p.upper = none;
  p.u = channel.empty()
            ? found_in(fit_.shared_uncertainty, name)
            : found_in(found_in(fit_.channel_uncertainty, channel).value_or(std::map<std::string, double>{}), name);
  p.interval_95 = found_in(fit_.interval_95, key);
  p.identifiable = found_in(fit_.identifiable, key).value_or(value.has_value());
  if (p.value && !p.u && p.interval_95) {
    // A value on its bound has no u, and its interval begins there.
    p.at_lower = *p.value <= p.interval_95->lower;
    p.at_upper = !p.at_lower && *p.value >= p.interval_95->upper;
    (p.at_lower ? p.lower : p.upper) = *p.value;
  }
  p.fixed = p.value && !p.u && !p.interval_95;
  rows_.push_back(std::move(p));
}

void Rows::add_shape() {
  Surface surface = material_.surface;
  for (const std::string_view name : surface_parameter_names) {
    const std::optional<double> value = *surface.find(name);
    if (value || fit_.identifiable.contains(std::string(name))) add({}, std::string(name), value, 0.0);
  }
  for (const auto& [name, value] : material_.parameters) add({}, name, value, 0.0);
}

void Rows::add_channel(const MaterialChannel& channel) {
  const auto fitted = [&](const std::string& name) { return fit_.identifiable.contains(channel.name + "." + name); };
  if (fitted("n")) add(channel.name, "n", channel.n, 0.0);
  if (fitted("f0")) add(channel.name, "f0", channel.f0, 0.0);
  for (const Coefficient c : all_coefficients) {
    const std::string name(name_of(c));
    const bool used = std::any_of(all_effects.begin(), all_effects.end(), [&](Effect effect) {
      return material_.components.has(effect) && coefficient_of(effect) == c;
    });
    if (used || fitted(name)) add(channel.name, name, channel.coefficient(c), 0.0);
  }
  for (const auto& [name, value] : channel.peer_k) add(channel.name, name, value, 0.0);
}

// Loss and RMS by the rule of fits, over all readings that one would use.
void add_sums(const Scan& scan, FitResult& result) {
  std::vector<AnglePair> angles;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (scan.theta_i_deg[row] >= 90.0 || scan.theta_r_deg[row] >= 90.0) continue;
    angles.push_back(scan.angles(row));
    rows.push_back(row);
  }
  result.samples = rows.size();
  result.left_out.at_90 = scan.size() - rows.size();
  if (rows.empty()) return;
  std::vector<double> fitted(rows.size() * scan.channels.size());
  BatchEvaluator<double>(result.material).values(PairBatch(angles), fitted);
  for (std::size_t c = 0; c < scan.channels.size(); ++c) {
    double squares = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double value = scan.channels[c].values[rows[i]];
      const double residual = fitted[c * rows.size() + i] - value;
      squares += residual * residual;
      result.loss += cos_deg(angles[i].theta_i_deg) * residual * residual;
      if (value < 0.0) ++result.left_out.negative_values;
    }
    result.channel_rms.push_back(std::sqrt(squares / static_cast<double>(rows.size())));
  }
  result.rms = std::sqrt(result.loss / static_cast<double>(rows.size() * scan.channels.size()));
  result.objective.value = result.loss;
}

std::optional<UncertaintySource> source_named(std::string_view name) {
  for (const UncertaintySource source :
       {UncertaintySource::readings, UncertaintySource::residuals, UncertaintySource::hc3, UncertaintySource::angles}) {
    if (name_of(source) == name) return source;
  }
  return std::nullopt;
}

bool is_open(const Material& material) {
  const auto open = [](const auto& named) { return !named.second.has_value(); };
  return std::any_of(material.parameters.begin(), material.parameters.end(), open);
}

}  // namespace

FitResult result_of_material(const Material& material, const Scan& scan) {
  const auto same = [](const MaterialChannel& a, const ScanChannel& b) { return a.name == b.name; };
  if (!std::equal(material.channels.begin(), material.channels.end(), scan.channels.begin(), scan.channels.end(),
                  same)) {
    throw usage_error("material " + in_quotes(material.name) + " and scan " + in_quotes(scan.name) +
                      " have different channels");
  }
  if (is_open(material)) {
    throw usage_error("material " + in_quotes(material.name) +
                      " has no values: a shape parameter of its model is null, expected a number");
  }
  FitResult result;
  result.material = material;
  result.parameters = Rows(material).take();
  result.converged = material.fit && material.fit->converged;
  if (material.fit) {
    result.uncertainty_from = source_named(material.fit->uncertainty_from).value_or(UncertaintySource::residuals);
  }
  add_sums(scan, result);
  result.diagnostics = diagnose(scan, material, {});
  return result;
}

}  // namespace goniofit
