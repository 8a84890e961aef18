#include "synthetic/verify.h"

#include <algorithm>
#include <optional>
#include <utility>

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

Trial run_trial(const Recipe& recipe, const Material& truth, std::uint64_t seed, const VerifyRun& run) {
  const VerifySettings& verify = *recipe.verify;
  Scan scan = simulate(truth, verify.sampling, verify.noise, seed, verify.known_noise);
  if (!recipe.channels.empty()) scan = select_channels(scan, recipe.channels);
  FitSettings settings = recipe.settings;
  if (recipe.optical_constants) use_optical_constants(*recipe.optical_constants, scan, settings);
  FitResult result = run.fitter(scan, settings);
  bool failed = !result.converged;
  // What "auto" chose is judged by the parameters it found; the minimum, among the effects it chose.
  if (settings.model == surface_model && !settings.components) settings.components = result.material.components;
  if (const std::optional<Material> start = start_of(truth, scan, settings.model)) {
    // To tell one minimum from another, which differ by far more.
    const double reachable = polish_from(scan, settings, *start, prediction_accuracy).loss;
    failed = failed || loss_ratio(scan, result.loss, reachable) > wrong_minimum_ratio;
  }
  return {std::move(result.parameters), failed};
}

/// What the trials found, by parameter in the order of the fit report. Fixed parameters and those without a truth have
/// nothing to recover.
class Recoveries {
 public:
  explicit Recoveries(const Material& truth) : truth_(truth) {}

  void add(const Trial& trial) {
    failures_ += trial.failed ? 1 : 0;
    for (const FittedParameter& p : trial.parameters) {
      if (p.fixed) continue;
      RecoveryTally* const tally = tally_of(p);
      if (tally != nullptr && p.value) tally->add(estimate_of(p));
    }
  }

  void fill(VerifyReport& report) const {
    report.failures = failures_;
    for (const RecoveryTally& tally : tallies_) {
      Recovery recovery = tally.result();
      if (recovery.determined == 0) {
        report.undetermined.push_back(recovery.parameter);
      } else {
        report.parameters.push_back(std::move(recovery));
      }
    }
  }

 private:
  RecoveryTally* tally_of(const FittedParameter& p) {
    const std::string name = p.channel.empty() ? p.name : p.channel + "." + p.name;
    const auto found =
        std::find_if(tallies_.begin(), tallies_.end(), [&](const RecoveryTally& t) { return t.parameter() == name; });
    if (found != tallies_.end()) return &*found;
    const std::optional<double> target = truth_of(truth_, p);
    if (!target) return nullptr;
    return &tallies_.emplace_back(name, *target, *target <= p.lower || *target >= p.upper);
  }

  const Material& truth_;
  std::size_t failures_ = 0;
  std::vector<RecoveryTally> tallies_;
};

// A block of trials at a time: enough for the threads not to wait for each other, few enough to hold. Within a block
// the trials are added in their order, so that sums do not depend on which ended first.
Recoveries run_trials(const Recipe& recipe, const Material& truth, std::size_t trials, std::uint64_t key,
                      const VerifyRun& run) {
  constexpr std::size_t block = 128;
  Recoveries recoveries(truth);
  for (std::size_t first = 0; first < trials; first += block) {
    std::vector<Trial> done(std::min(block, trials - first));
    const auto task = [&](std::size_t t) { done[t] = run_trial(recipe, truth, subkey(key, first + t), run); };
    const auto progress = [&](std::size_t ended, std::size_t) {
      if (run.progress) run.progress(first + ended, trials);
    };
    parallel_for(done.size(), task, progress, run.threads);
    for (const Trial& trial : done) recoveries.add(trial);
  }
  return recoveries;
}

}  // namespace

VerifyReport verify_recipe(const Recipe& recipe, std::size_t trials, std::uint64_t seed, const VerifyRun& run) {
  const std::string source = recipe.source.string();
  if (!recipe.verify) throw key_error(source, "/verify", "missing; a recipe to verify names its truth there");
  if (trials == 0) trials = recipe.verify->trials;
  if (trials == 0) throw key_error(source, "/verify/trials", "is 0, expected at least 1");
  const Material truth = read_material(recipe.verify->truth);

  VerifyReport report;
  report.name = recipe.source.stem().string();
  report.settings = *recipe.verify;
  report.seed = seed;
  report.trials = trials;
  run_trials(recipe, truth, trials, subkey(seed, report.name), run).fill(report);
  judge({&report, 1});
  return report;
}

}  // namespace goniofit
