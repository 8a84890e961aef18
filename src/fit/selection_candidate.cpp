#include "fit/selection_candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fit/model.h"
#include "fit/profile.h"
#include "fit/solve.h"

namespace goniofit {

namespace {

// Inverse standard deviations, as factors of the weighted residuals.
std::vector<Eigen::VectorXd> emphasis_for(const Problem& problem, const Eigen::VectorXd& variance) {
  const auto n = static_cast<Eigen::Index>(problem.samples());
  std::vector<Eigen::VectorXd> emphasis;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const auto own = variance.segment(static_cast<Eigen::Index>(c) * n, n);
    constexpr double largest = 1e100;  // where neither reading nor model has any noise: squares still are numbers
    emphasis.emplace_back((own.cwiseSqrt().cwiseProduct(problem.weight)).cwiseInverse().cwiseMin(largest));
  }
  return emphasis;
}

bool inside(double value, double lower, double upper) {
  const auto off = [value](double bound) {
    return !std::isfinite(bound) || std::fabs(value - bound) > 1e-9 * (1.0 + std::fabs(bound));
  };
  return lower < upper && off(lower) && off(upper);
}

bool vanishes(const Problem& problem, const FitPoint& point, std::size_t coefficient) {
  return std::all_of(point.coefficients.begin(), point.coefficients.end(),
                     [&](const SmallVector& k) { return k[static_cast<Eigen::Index>(coefficient)] == 0.0; }) &&
         !problem.basis->coefficients()[coefficient].constant();
}

// A shape parameter counts where some lobe shows it, an optical one where some coefficient does.
std::size_t count_free(const Problem& problem, const FitPoint& point) {
  std::size_t count = 0;
  bool lobes = false;
  for (const BasisColumn& c : problem.basis->columns()) {
    lobes = lobes || (c.reads_shape && !vanishes(problem, point, c.coefficient));
  }
  for (std::size_t z = 0; lobes && z < point.z.size(); ++z) {
    if (inside(point.z[z], problem.shape.lower[z], problem.shape.upper[z])) ++count;
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    bool optics = false;
    for (const BasisColumn& column : problem.basis->columns()) {
      const bool there = point.coefficients[c][static_cast<Eigen::Index>(column.coefficient)] != 0.0;
      optics = optics || (there && column.optics != OpticsFactor::one);
    }
    for (Eigen::Index j = 0; j < channel.lower.size(); ++j) {
      if (inside(point.coefficients[c][j], channel.lower[j], channel.upper[j])) ++count;
    }
    if (optics && !point.optics.empty() && inside(point.optics[c], channel.optics_lower, channel.optics_upper)) ++count;
  }
  return count;
}

void add_criteria(Candidate& candidate) {
  const Problem& problem = *candidate.problem;
  SelectionRow& row = candidate.row;
  row.chi2 = candidate.weighted.loss;
  row.free_parameters = count_free(problem, candidate.weighted);
  const auto p = static_cast<double>(row.free_parameters);
  const auto n = static_cast<double>(problem.samples() * problem.channels.size());
  row.bic = row.chi2 + p * std::log(n);
  row.aicc = row.chi2 + 2.0 * p + (n - p > 1.0 ? 2.0 * p * (p + 1.0) / (n - p - 1.0) : 2.0 * p * p);
}

// The larger set's shape, or nullopt where it has other shape parameters.
std::optional<std::vector<double>> shape_from(const Problem& problem, const Candidate& larger) {
  const Problem& from = *larger.problem;
  if (from.shape.free != problem.shape.free) return std::nullopt;
  for (std::size_t z = 0; z < problem.shape.row.size(); ++z) {
    const auto name = [z](const Problem& p) {
      return p.basis->shape_parameters()[static_cast<std::size_t>(p.shape.row[z])].name;
    };
    if (name(problem) != name(from)) return std::nullopt;
  }
  return larger.asked.z;
}

}  // namespace

Candidate fit_candidate(const Scan& scan, const FitSettings& settings, EffectSet set, const Candidate* larger) {
  FitSettings own = settings;
  own.components = set;
  Candidate candidate;
  candidate.problem = std::make_unique<Problem>(scan, own);
  const Problem& problem = *candidate.problem;
  const auto shape = larger == nullptr ? std::nullopt : shape_from(problem, *larger);
  if (shape) {
    candidate.asked = polish(problem, Profile(problem).point(shape->data()), prediction_accuracy).point;
  } else {
    candidate.asked = solve(problem, prediction_accuracy).best.point;
  }
  candidate.weighted = candidate.asked;
  candidate.row.components = set;
  candidate.row.loss = candidate.asked.loss;
  return candidate;
}

Prediction predict(const Candidate& candidate) {
  const Problem& problem = *candidate.problem;
  const auto n = static_cast<Eigen::Index>(problem.samples());
  Prediction p{Eigen::VectorXd(n * static_cast<Eigen::Index>(problem.channels.size())), {}};
  p.residual.resize(p.f.size());
  Model model(problem);
  model.set_shape(candidate.weighted.z.data(), false);
  Eigen::VectorXd r;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    if (!candidate.weighted.optics.empty()) model.set_optics(c, candidate.weighted.optics[c]);
    model.residuals(c, candidate.weighted.coefficients[c], r);
    if (problem.channels[c].emphasis.size() > 0) r = r.cwiseQuotient(problem.channels[c].emphasis);
    const auto at = static_cast<Eigen::Index>(c) * n;
    p.residual.segment(at, n) = r.cwiseQuotient(problem.weight);
    p.f.segment(at, n) = (r + problem.channels[c].target).cwiseQuotient(problem.weight);
  }
  return p;
}

void fit_weighted(Candidate& candidate, const Eigen::VectorXd& variance) {
  candidate.problem->emphasise(emphasis_for(*candidate.problem, variance));
  candidate.weighted = polish(*candidate.problem, candidate.weighted, prediction_accuracy).point;
  add_criteria(candidate);
}

Eigen::VectorXd stated_variance(const Problem& problem) {
  const auto n = static_cast<Eigen::Index>(problem.samples());
  Eigen::VectorXd variance(n * static_cast<Eigen::Index>(problem.channels.size()));
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const Eigen::VectorXd& u = problem.channels[c].u;
    if (u.size() == 0) return {};
    variance.segment(static_cast<Eigen::Index>(c) * n, n) = u.cwiseAbs2();
  }
  return variance;
}

void add_weights(const std::vector<SelectionRow*>& rows) {
  const auto add = [&rows](double SelectionRow::*criterion, double SelectionRow::*weight) {
    double least = std::numeric_limits<double>::infinity();
    for (const SelectionRow* row : rows) least = std::min(least, row->*criterion);
    double sum = 0.0;
    for (SelectionRow* row : rows) sum += row->*weight = std::exp(0.5 * (least - row->*criterion));
    for (SelectionRow* row : rows) row->*weight /= sum;
  };
  add(&SelectionRow::aicc, &SelectionRow::aicc_weight);
  add(&SelectionRow::bic, &SelectionRow::bic_weight);
}

bool as_good(const SelectionRow& row, const SelectionRow& best) {
  return row.difference && (*row.difference <= *row.difference_error || row.bic <= best.bic);
}

bool contains(EffectSet larger, EffectSet smaller) noexcept {
  return std::all_of(all_effects.begin(), all_effects.end(),
                     [&](Effect e) { return larger.has(e) || !smaller.has(e); });
}

}  // namespace goniofit
