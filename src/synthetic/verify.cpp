#include "synthetic/verify.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fit/polish.h"
#include "io/material_io.h"
#include "io/recipe_optics.h"
#include "support/error.h"
#include "synthetic/parallel.h"
#include "synthetic/random.h"
#include "synthetic/recovery.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

std::optional<double> shared_truth(const Material& truth, const std::string& name) {
  if (truth.model != surface_model) {
    const auto found = truth.parameters.find(name);
    return found == truth.parameters.end() ? std::nullopt : found->second;
  }
  Surface surface = truth.surface;
  const std::optional<double>* const known = surface.find(name);
  return known == nullptr ? std::nullopt : *known;
}

std::optional<double> channel_truth(const MaterialChannel& channel, const std::string& name) {
  if (name == "n") return channel.n;
  if (name == "f0") return channel.normal_reflectance();
  return channel.coefficient(name);
}

std::optional<double> truth_of(const Material& truth, const FittedParameter& parameter) {
  if (parameter.channel.empty()) return shared_truth(truth, parameter.name);
  for (const MaterialChannel& channel : truth.channels) {
    if (channel.name == parameter.channel) return channel_truth(channel, parameter.name);
  }
  return std::nullopt;
}

// The truth as a start of the polish: its channels those of the scan. None where another model is fitted, which has no
// such point.
std::optional<Material> start_of(const Material& truth, const Scan& scan, const std::string& model) {
  if (truth.model != model) return std::nullopt;
  for (const auto& [name, value] : truth.parameters) {
    if (!value) return std::nullopt;
  }
  Material start = truth;
  start.channels.clear();
  for (const ScanChannel& channel : scan.channels) {
    const auto found = std::find_if(truth.channels.begin(), truth.channels.end(),
                                    [&](const MaterialChannel& c) { return c.name == channel.name; });
    start.channels.push_back(*found);
  }
  return start;
}

struct Trial {
  std::vector<FittedParameter> parameters;
  bool failed = false;
};

Trial run_trial(const Recipe& recipe, const Material& truth, std::uint64_t seed) {
  const VerifySettings& verify = *recipe.verify;
  Scan scan = simulate(truth, verify.sampling, verify.noise, seed);
  if (!recipe.channels.empty()) scan = select_channels(scan, recipe.channels);
  FitSettings settings = recipe.settings;
  if (recipe.optical_constants) use_optical_constants(*recipe.optical_constants, scan, settings);
  FitResult result = fit(scan, settings);
  bool failed = !result.converged;
  // What "auto" chose is judged by the parameters it found; the minimum, among the effects it chose.
  if (settings.model == surface_model && !settings.components) settings.components = result.material.components;
  if (const std::optional<Material> start = start_of(truth, scan, settings.model)) {
    const double reachable = polish_from(scan, settings, *start).loss;
    failed = failed || loss_ratio(scan, result.loss, reachable) > wrong_minimum_ratio;
  }
  return {std::move(result.parameters), failed};
}

/// Groups what the trials found by parameter, in the order of the fit report. Fixed parameters and those without a
/// truth have nothing to recover; a trial whose scan did not determine a parameter does not count for it.
std::vector<ParameterTrials> by_parameter(const Material& truth, const std::vector<Trial>& trials) {
  std::vector<ParameterTrials> groups;
  for (const Trial& trial : trials) {
    for (const FittedParameter& p : trial.parameters) {
      const std::optional<double> target = truth_of(truth, p);
      if (p.fixed || !p.value || !target) continue;
      const std::string name = p.channel.empty() ? p.name : p.channel + "." + p.name;
      auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.parameter == name; });
      if (group == groups.end()) {
        groups.push_back({name, *target, *target <= p.lower || *target >= p.upper, {}});
        group = groups.end() - 1;
      }
      group->estimates.push_back({*p.value, p.u});
    }
  }
  return groups;
}

}  // namespace

VerifyReport verify_recipe(const Recipe& recipe, std::size_t trials, std::uint64_t seed, const Progress& progress) {
  const std::string source = recipe.source.string();
  if (!recipe.verify) throw key_error(source, "/verify", "missing; a recipe to verify names its truth there");
  if (trials == 0) trials = recipe.verify->trials;
  if (trials == 0) throw key_error(source, "/verify/trials", "is 0, expected at least 1");
  const Material truth = read_material(recipe.verify->truth);

  std::vector<Trial> done(trials);
  parallel_for(
      trials, [&](std::size_t t) { done[t] = run_trial(recipe, truth, subkey(seed, t)); }, progress);

  VerifyReport report;
  report.name = recipe.source.stem().string();
  report.trials = trials;
  for (const Trial& trial : done) report.failures += trial.failed ? 1 : 0;
  const std::vector<ParameterTrials> groups = by_parameter(truth, done);
  for (const ParameterTrials& group : groups) report.parameters.push_back(recovery_of(group));
  report.missed = missed_bounds(groups, *recipe.verify);
  if (report.failures > 0) {
    report.missed.push_back(
        fmt::format("{} of {} fits did not converge or ended in a wrong minimum", report.failures, trials));
  }
  return report;
}

}  // namespace goniofit
