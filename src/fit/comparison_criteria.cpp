#include "fit/comparison_criteria.h"
#include "fit/material_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "fit/polish.h"
#include "fit/selection_noise.h"

namespace goniofit {

namespace {

// The model that was fitted, at its fit. Automatic components are by now what was chosen, and terms that the scan left
// open are those of the material.
Candidate candidate_of(const Scan& scan, const FitSettings& settings, const ComparedFit& row) {
  FitSettings own = settings_for_model(row.model, settings);
  own.reflectances.reset();  // criteria are of the scan's readings
  if (own.model == surface_model) {
    own.components = row.fit.material.components;
    if (own.terms.distribution != row.fit.material.terms.distribution) own.parameters.erase("tail");
    own.terms = row.fit.material.terms;
    const bool length = own.components->has(Effect::coh) || own.terms.distribution != DistributionTier::rough_limit;
    for (const char* name : {"sigma_um", "tau_um"}) {
      const auto at = own.parameters.find(name);
      if (at != own.parameters.end() && !length && !at->second.value) own.parameters.erase(at);
    }
  }
  Candidate candidate;
  candidate.problem = std::make_unique<Problem>(scan, own);
  candidate.asked = point_of(*candidate.problem, row.fit.material);
  candidate.weighted = candidate.asked;
  candidate.row.components = candidate.problem->components;
  candidate.row.loss = row.fit.loss;
  return candidate;
}

NoiseModel likeliest_noise(std::vector<Candidate>& candidates) {
  NoiseModel best;
  for (Candidate& c : candidates) {
    if (NoiseModel own = noise_of(c); own.deviance < best.deviance || best.variance.size() == 0) best = std::move(own);
  }
  return best;
}

std::size_t best_of(const std::vector<Candidate>& candidates, bool by_angles) {
  std::size_t best = 0;
  const auto criterion = [&](std::size_t i) {
    return by_angles ? *candidates[i].row.cross_validated : candidates[i].row.bic;
  };
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (criterion(i) < criterion(best)) best = i;
  }
  return best;
}

void cross_validate(std::vector<Candidate>& candidates, const AngleGroups& groups, double readings) {
  for (Candidate& c : candidates) {
    c.left_out = left_out_scores(*c.problem, c.weighted, groups);
    c.row.cross_validated = c.left_out.sum() / readings;
  }
  const Candidate& best = candidates[best_of(candidates, true)];
  for (Candidate& c : candidates) {
    const Eigen::VectorXd d = (c.left_out - best.left_out) / readings;
    c.row.difference = d.sum();
    c.row.difference_error = paired_error(d);
  }
}

std::size_t simplest_as_good(const std::vector<Candidate>& candidates, std::size_t best) {
  std::size_t simplest = best;
  const auto key = [&](std::size_t i) {
    const SelectionRow& row = candidates[i].row;
    return std::tuple(row.free_parameters, *row.cross_validated);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (as_good(candidates[i].row, candidates[best].row) && key(i) < key(simplest)) simplest = i;
  }
  return simplest;
}

std::string verdict_of(const Comparison& comparison, std::size_t chosen, std::size_t best) {
  const auto text = [&](std::size_t i) {
    const ComparedFit& row = comparison.rows[i];
    const std::size_t free = row.criteria.free_parameters;
    return fmt::format("{} ({} free parameter{})", row.model, free, free == 1 ? "" : "s");
  };
  if (comparison.groups == 0) {
    return text(chosen) +
           " has the least BIC; with fewer than four incidence angles none can be left out to be predicted";
  }
  if (chosen == best) {
    return fmt::format("{} predicts left-out incidence angles best, and no simpler model does as well", text(best));
  }
  return fmt::format("the simplest model not distinguishable from the best: {}; the best: {}", text(chosen),
                     text(best));
}

}  // namespace

void add_criteria(const Scan& scan, const FitSettings& settings, Comparison& comparison) {
  constexpr std::size_t least_groups = 4;
  std::vector<Candidate> candidates;
  for (const ComparedFit& row : comparison.rows) candidates.push_back(candidate_of(scan, settings, row));
  const NoiseModel noise = likeliest_noise(candidates);
  for (Candidate& c : candidates) fit_weighted(c, noise.variance);
  std::vector<SelectionRow*> rows;
  for (Candidate& c : candidates) rows.push_back(&c.row);
  add_weights(rows);
  const AngleGroups groups = angle_groups(*candidates.front().problem);
  const bool by_angles = groups.count() >= least_groups;
  if (by_angles) cross_validate(candidates, groups, static_cast<double>(noise.variance.size()));
  const std::size_t best = best_of(candidates, by_angles);
  const std::size_t chosen = by_angles ? simplest_as_good(candidates, best) : best;
  comparison.noise = noise.noise;
  comparison.u_scale = noise.u_scale;
  comparison.groups = by_angles ? groups.count() : 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    comparison.rows[i].criteria = candidates[i].row;
    comparison.rows[i].criteria.chosen = i == chosen;
  }
  comparison.verdict = verdict_of(comparison, chosen, best);
}

}  // namespace goniofit
