#include "fit/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fit/linear_step.h"
#include "fit/model.h"
#include "fit/polish.h"

namespace goniofit {

namespace {

constexpr std::size_t most_groups = 8;
constexpr double tail_freedom = 4.0;
constexpr double score_scale = 5.161239056645861;  // 1 over the mean of ln(1 + z²/4) for a standard normal z

// Tenths of a degree.
long angle_key(double theta_i_deg) { return std::lround(10.0 * theta_i_deg); }

std::vector<Eigen::VectorXd> emphasis_of(const Problem& problem) {
  std::vector<Eigen::VectorXd> all;
  for (const ProblemChannel& c : problem.channels) all.push_back(c.emphasis);
  return all;
}

}  // namespace

AngleGroups angle_groups(const Problem& problem) {
  std::map<long, std::size_t> readings;
  for (const double theta_i_deg : problem.theta_i_deg) ++readings[angle_key(theta_i_deg)];
  const std::size_t count = std::min(readings.size(), most_groups);
  const bool one_each = readings.size() <= most_groups;
  std::map<long, std::size_t> group;
  std::size_t before = 0;
  for (const auto& [angle, n] : readings) {
    group[angle] = one_each ? group.size() : std::min(count - 1, (before + n / 2) * count / problem.samples());
    before += n;
  }
  AngleGroups groups;
  std::map<std::size_t, std::size_t> dense;  // a group that one crowded angle skipped has no number
  for (const auto& [angle, g] : group) dense.try_emplace(g, dense.size());
  groups.readings.assign(dense.size(), 0.0);
  for (const double theta_i_deg : problem.theta_i_deg) {
    groups.of.push_back(dense.at(group.at(angle_key(theta_i_deg))));
    groups.readings[groups.of.back()] += 1.0;
  }
  return groups;
}

namespace {

// What a point makes of the readings, group by group: their scores and their squares.
struct Judged {
  Eigen::VectorXd scores, squares;
};

Judged judge(Model& model, const Problem& problem, const FitPoint& point, const AngleGroups& groups) {
  model.set_shape(point.z.data(), false);
  const auto count = static_cast<Eigen::Index>(groups.count());
  Judged judged{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  Eigen::VectorXd r;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    if (!point.optics.empty()) model.set_optics(c, point.optics[c]);
    model.residuals(c, point.coefficients[c], r);
    for (std::size_t i = 0; i < groups.of.size(); ++i) {
      const double square = r[static_cast<Eigen::Index>(i)] * r[static_cast<Eigen::Index>(i)];
      const auto g = static_cast<Eigen::Index>(groups.of[i]);
      judged.scores[g] += score_scale * std::log1p(square / tail_freedom);
      judged.squares[g] += square;
    }
  }
  return judged;
}

FitPoint polished_without(Problem& problem, const FitPoint& start, const AngleGroups& groups, std::size_t group) {
  std::vector<Eigen::VectorXd> all = emphasis_of(problem);
  std::vector<Eigen::VectorXd> others = all;
  for (Eigen::VectorXd& emphasis : others) {
    for (std::size_t i = 0; i < groups.of.size(); ++i) {
      if (groups.of[i] == group) emphasis[static_cast<Eigen::Index>(i)] = 0.0;
    }
  }
  problem.emphasise(std::move(others));
  FitPoint point = polish(problem, start, prediction_accuracy).point;
  problem.emphasise(std::move(all));
  return point;
}

}  // namespace

Eigen::VectorXd group_scores(const Problem& problem, const FitPoint& point, const AngleGroups& groups) {
  Model model(problem);
  return judge(model, problem, point, groups).scores;
}

Eigen::VectorXd left_out_scores(Problem& problem, const FitPoint& start, const AngleGroups& groups) {
  // In units of the noise: what a fit may miss its minimum by, far below what a choice reads from it.
  constexpr double absolute = 0.5, relative = 1e-4;
  const GroupedEquations equations(problem, start, groups.of, groups.count());
  Model model(problem);
  Eigen::VectorXd scores(static_cast<Eigen::Index>(groups.count()));
  for (std::size_t g = 0; g < groups.count(); ++g) {
    const auto own = static_cast<Eigen::Index>(g);
    const GroupedEquations::Step step = equations.without(g);
    Judged judged = judge(model, problem, step.point, groups);
    const double others = judged.squares.sum() - judged.squares[own];
    // Not where the linearisation does not hold so far, or is none (a value left the range of doubles).
    if (!(std::fabs(others - step.promised) <= absolute + relative * step.promised)) {
      judged = judge(model, problem, polished_without(problem, start, groups, g), groups);
    }
    scores[own] = judged.scores[own];
  }
  return scores;
}

double paired_error(const Eigen::VectorXd& differences) {
  const auto groups = static_cast<double>(differences.size());
  return std::sqrt(groups / (groups - 1.0) * (differences.array() - differences.mean()).square().sum());
}

}  // namespace goniofit
