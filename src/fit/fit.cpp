#include "fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "brdf/evaluator.h"
#include "fit/assemble.h"
#include "fit/fit_evidence.h"
#include "fit/fit_spread.h"
#include "fit/identifiability_analysis.h"
#include "fit/likelihood_profile.h"
#include "fit/problem.h"
#include "fit/scan_support.h"
#include "fit/solve.h"

namespace goniofit {

namespace {

// A fit with what its profiles need.
struct Fitted {
  FitResult result;
  std::unique_ptr<Problem> problem;
  std::unique_ptr<Model> model;
  FitPoint point;
};

void look_at(const Problem& problem, Model& model, const FitPoint& point, FitEvidence& e) {
  if (!problem.by_parts()) e.l = linearise(problem, model, point);
  const LinearParts parts(problem, point, e.l);
  e.noise = noise_model(parts);
  e.sums = linear_sums(parts, &e.noise);
}

// The k_fs of a channel; none where the model has none, or the settings demand one.
std::optional<std::size_t> free_fs(const Problem& problem, std::size_t channel) {
  for (const std::size_t j : subsurface_coefficients(problem)) {
    const bool may_vanish = problem.channels[channel].lower[static_cast<Eigen::Index>(j)] <= 0.0;
    if (may_vanish && problem.basis->coefficients()[j].name == name_of(Coefficient::k_fs)) return j;
  }
  return std::nullopt;
}

// A k_fs that the readings leave open by itself is whatever their noise makes of it, since no upper bound stops it: the
// minimum without.
void leave_out_unseen_fs(Problem& problem, Model& model, Polished& best, FitEvidence& evidence) {
  HeldAtZero held(problem);
  FitPoint start = best.point;
  for (const OpenDirection& open : evidence.identifiability.open) {
    if (open.names != std::vector<std::string>{std::string(name_of(Coefficient::k_fs))}) continue;
    for (std::size_t c = 0; c < problem.channels.size(); ++c) {
      const std::optional<std::size_t> fs = free_fs(problem, c);
      if (problem.channels[c].name != open.channel || !fs) continue;
      held.hold(c, *fs);
      start.coefficients[c][static_cast<Eigen::Index>(*fs)] = 0.0;
      evidence.no_fs.push_back(c);
    }
  }
  if (start.coefficients == best.point.coefficients) return;
  const std::size_t before = best.iterations;
  best = polish(problem, model, start);
  best.iterations += before;
}

// The minimum, less what cannot be in the scan: light from below a metal, and lobes that only its noise has.
Solved solve_sensibly(Problem& problem, Model& model, const FitSettings& settings, FitEvidence& evidence) {
  HeldAtZero held(problem);
  const std::vector<std::size_t> opaque = opaque_channels(problem);
  for (const std::size_t c : opaque) {
    for (const std::size_t j : subsurface_coefficients(problem)) {
      const auto k = static_cast<Eigen::Index>(j);
      if (problem.channels[c].lower[k] < problem.channels[c].upper[k]) held.hold(c, j);
    }
  }
  Solved solved = solve(problem, model, settings);
  Polished& best = solved.best;
  look_at(problem, model, best.point, evidence);
  const LobeTest lobes = test_lobes(problem, best.point, evidence.sums);
  if (!lobes.significant) {
    best = without_lobes(problem, model, best);
    look_at(problem, model, best.point, evidence);
    evidence.no_lobes = lobes;
  }
  evidence.opaque = opaque;
  evidence.identifiability = identify(problem, best.point, evidence.sums);
  leave_out_unseen_fs(problem, model, best, evidence);
  if (!evidence.no_fs.empty()) {
    look_at(problem, model, best.point, evidence);
    evidence.identifiability = identify(problem, best.point, evidence.sums);
  }
  return solved;
}

Fitted fit_as_asked(const Scan& scan, const FitSettings& settings);

Fitted without_coherence(const Scan& scan, FitSettings settings, double p) {
  settings.components->erase(Effect::coh);
  settings.components->insert(Effect::dd);
  settings.parameters.erase("sigma_um");  // whose bounds have no meaning then
  settings.profile.reset();               // its names were checked
  Fitted fitted = fit_as_asked(scan, settings);
  fitted.result.warnings.push_back(
      fmt::format("coh was left out: it does not stand clear of the noise (probability {:.2g} under noise alone), so "
                  "sigma_um is not determined; the surface is too rough for these wavelengths to reflect coherently, "
                  "or mirror readings are few",
                  p));
  return fitted;
}

Fitted fit_as_asked(const Scan& scan, const FitSettings& settings) {
  auto problem = std::make_unique<Problem>(scan, settings, Problem::Hold::parts);
  if (settings.profile) check_profile_names(*problem, *settings.profile);
  FitEvidence evidence;
  auto model = std::make_unique<Model>(*problem);
  const Solved solved = solve_sensibly(*problem, *model, settings, evidence);
  FitResult result = assemble(*problem, scan, solved.best, evidence);
  const double p = noise_makes_coherence(LinearParts(*problem, solved.best.point, evidence.l), evidence.noise,
                                         evidence.sums.loss, result.material);
  if (p >= lobe_level) return without_coherence(scan, settings, p);
  result.search_evaluations = solved.evaluations;
  result.polish_starts = solved.starts;
  result.polish_iterations = solved.iterations;
  return {std::move(result), std::move(problem), std::move(model), solved.best.point};
}

// Whether the scan leaves open what tells the distribution asked for from its rough limit: the tail of student-t, or
// sigma of wave optics, unknown, on its upper bound, or known to no better than half of itself.
const char* open_parameter(const FitResult& r) {
  const DistributionTier d = r.material.terms.distribution;
  const EffectSet effects = r.material.components;
  if (!effects.has(Effect::dd) || !r.material.surface.slope) return nullptr;
  const auto row = [&](const char* name) {
    return std::find_if(r.parameters.begin(), r.parameters.end(),
                        [name](const FittedParameter& p) { return p.name == name; });
  };
  if (d == DistributionTier::student_t) {
    const FittedParameter& tail = *row("tail");
    if (tail.fixed) return nullptr;
    // What a tail changes falls with 1/tail: no four standard deviations off nothing is no tail.
    const bool weak = tail.value && tail.u && *tail.u > 0.25 * (*tail.value - 1.0);
    return !tail.value || tail.at_upper || weak ? "tail" : nullptr;
  }
  if (d == DistributionTier::rough_limit || effects.has(Effect::coh)) return nullptr;
  const FittedParameter& sigma = *row("sigma_um");
  const bool loose = sigma.u && *sigma.u > 0.5 * *sigma.value;
  return !sigma.fixed && (!sigma.value || sigma.at_upper || loose) ? "sigma_um" : nullptr;
}

// What wave optics changes falls with 1/sigma². Where sigma is open by half of itself, that change is not to be told
// from none by the scan's own scatter: then the rough limit, which has no sigma, is the answer, unless it is far worse.
void settle_distribution(const Scan& scan, FitSettings settings, Fitted& fitted) {
  FitResult& result = fitted.result;
  const char* const name = open_parameter(result);
  if (name == nullptr) return;
  const std::string asked_for(name_of(settings.terms.distribution));
  settings.terms.distribution = DistributionTier::rough_limit;
  settings.parameters.erase(name);
  settings.profile.reset();  // its names were checked
  Fitted without = fit_as_asked(scan, settings);
  FitResult& rough = without.result;
  if (rough.objective.value > 1.1 * result.objective.value) return;
  rough.warnings.push_back(std::string(name) + " is not determined: nothing in this scan tells the distribution " +
                           asked_for + " from its rough limit, which the material has instead");
  rough.search_evaluations += result.search_evaluations;
  rough.polish_iterations += result.polish_iterations;
  fitted = std::move(without);
}

// Intervals from the profiles take the place of those from u. A fit that a profile went below is none.
void add_profiles(const std::vector<std::string>& names, Fitted& fitted) {
  FitResult& result = fitted.result;
  result.profiles = likelihood_profiles(*fitted.problem, fitted.point, result.parameters, names);
  for (const LikelihoodProfile& profile : result.profiles) {
    if (profile.lower_loss) {
      result.converged = result.material.fit->converged = false;
      result.warnings.push_back("the profile of " + profile.key() +
                                " met a lower loss than the fit's: this is not the best fit; bound the parameters "
                                "closer, or try fewer components");
    }
    const auto row = std::find_if(result.parameters.begin(), result.parameters.end(), [&](const FittedParameter& p) {
      return p.name == profile.name && p.channel == profile.channel;
    });
    if (row == result.parameters.end() || !row->value || !profile.interval_95) continue;
    row->interval_68 = profile.interval_68;
    row->interval_95 = profile.interval_95;
    const bool finite = std::isfinite(profile.interval_95->lower) && std::isfinite(profile.interval_95->upper);
    if (finite) result.material.fit->interval_95[profile.key()] = *profile.interval_95;
  }
}

// A peer of which the scan leaves a parameter open has none.
bool has_values(const Material& m) {
  return std::all_of(m.parameters.begin(), m.parameters.end(), [](const auto& p) { return p.second.has_value(); });
}

// Takes the problem's rows.
UsedReadings used_readings(Problem& problem) {
  UsedReadings used{std::move(problem.rows), {}};
  for (const ProblemChannel& c : problem.channels) {
    std::vector<bool>& out = used.left_out.emplace_back();
    for (std::size_t i = 0; c.used.size() > 0 && i < used.rows.size(); ++i) {
      out.push_back(c.used[static_cast<Eigen::Index>(i)] == 0.0);
    }
  }
  return used;
}

// Those that the scan determined.
std::size_t free_parameters(const FitResult& r) {
  const auto is_free = [](const FittedParameter& p) {
    return p.value && !p.fixed && !p.derived && !p.at_lower && !p.at_upper;
  };
  return static_cast<std::size_t>(std::count_if(r.parameters.begin(), r.parameters.end(), is_free));
}

}  // namespace

std::string_view name_of(ParameterFlag flag) noexcept {
  switch (flag) {
    case ParameterFlag::fixed:
      return "fixed";
    case ParameterFlag::at_bound:
      return "at_bound";
    case ParameterFlag::at_start:
      return "at_start";
    case ParameterFlag::degenerate:
      return "degenerate";
    case ParameterFlag::insignificant:
      return "insignificant";
    case ParameterFlag::unsupported:
      return "unsupported";
    case ParameterFlag::opaque:
      break;
  }
  return "opaque";
}

bool FittedParameter::has(ParameterFlag flag) const noexcept {
  return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

FitResult fit(const Scan& scan, const FitSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  FitSettings own = settings;
  std::optional<Selection> selection;
  if (settings.model == surface_model && !settings.components) {
    FitSettings of_scan = settings;
    of_scan.reflectances.reset();  // what predicts readings left out is judged by the readings alone
    selection = select_components(scan, of_scan);
    own.components = selection->chosen();
  }
  Fitted fitted = fit_as_asked(scan, own);
  settle_distribution(scan, own, fitted);
  if (own.profile) add_profiles(*own.profile, fitted);
  FitResult result = std::move(fitted.result);
  if (selection) {
    result.notes.insert(result.notes.begin(), selection->reason);
    result.components_were_auto = true;
    result.selection = std::move(selection);
  }
  if (has_values(result.material)) {
    DiagnosticsOptions options{.weight = result.weight,
                               .free_parameters = free_parameters(result),
                               .values = fitted_values(*fitted.problem, *fitted.model, fitted.point, result.material)};
    options.used = used_readings(*fitted.problem);
    if (!options.values || options.values->pairs == nullptr) fitted.problem.reset();  // its memory is wanted
    result.diagnostics = diagnose(scan, result.material, std::move(options));
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void add_reflectance(FitResult& result, const Scan& scan, std::size_t most) {
  std::set<double> angles;
  for (const double theta : scan.theta_i_deg) {
    if (theta < 90.0) angles.insert(std::round(theta * 10.0) / 10.0);
  }
  const std::vector<double> all(angles.begin(), angles.end());
  const std::size_t count = std::min(most, all.size());
  const Evaluator evaluator(result.material);
  bool above_one = false;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = count > 1 ? all[i * (all.size() - 1) / (count - 1)] : all.front();
    HemisphericalReflectance row{theta, hemispherical_reflectance(evaluator, theta)};
    above_one = above_one || *std::max_element(row.by_channel.begin(), row.by_channel.end()) > 1.0;
    result.reflectance.push_back(std::move(row));
  }
  if (above_one) {
    result.warnings.emplace_back(
        "the fitted material reflects more than it receives at some incidence angles; check the scan's absolute scale, "
        "or bound the k's");
  }
}

}  // namespace goniofit
