#include "fit/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fit/model.h"
#include "fit/polish.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

constexpr std::size_t most_groups = 8;
constexpr double tail_freedom = 4.0;
constexpr double score_scale = 5.161239056645861;  // 1 over the mean of ln(1 + z²/4) for a standard normal z

// Tenths of a degree.
long angle_key(double cos_i) { return std::lround(10.0 * degrees(std::acos(std::clamp(cos_i, -1.0, 1.0)))); }

std::vector<Eigen::VectorXd> emphasis_of(const Problem& problem) {
  std::vector<Eigen::VectorXd> all;
  for (const ProblemChannel& c : problem.channels) all.push_back(c.emphasis);
  return all;
}

}  // namespace

AngleGroups angle_groups(const Problem& problem) {
  std::map<long, std::size_t> readings;
  for (const double cos_i : problem.pairs.cos_i) ++readings[angle_key(cos_i)];
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
  for (const double cos_i : problem.pairs.cos_i) {
    groups.of.push_back(dense.at(group.at(angle_key(cos_i))));
    groups.readings[groups.of.back()] += 1.0;
  }
  return groups;
}

Eigen::VectorXd group_scores(const Problem& problem, const FitPoint& point, const AngleGroups& groups) {
  Model model(problem);
  model.set_shape(point.z.data(), false);
  Eigen::VectorXd scores = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(groups.count()));
  Eigen::VectorXd r;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    if (!point.optics.empty()) model.set_optics(c, point.optics[c]);
    model.residuals(c, point.coefficients[c], r);
    for (std::size_t i = 0; i < groups.of.size(); ++i) {
      const double deviation = r[static_cast<Eigen::Index>(i)];
      scores[static_cast<Eigen::Index>(groups.of[i])] += score_scale * std::log1p(deviation * deviation / tail_freedom);
    }
  }
  return scores;
}

Eigen::VectorXd left_out_scores(Problem& problem, const FitPoint& start, const AngleGroups& groups) {
  const std::vector<Eigen::VectorXd> all = emphasis_of(problem);
  Eigen::VectorXd scores(static_cast<Eigen::Index>(groups.count()));
  for (std::size_t g = 0; g < groups.count(); ++g) {
    std::vector<Eigen::VectorXd> others = all;
    for (Eigen::VectorXd& emphasis : others) {
      for (std::size_t i = 0; i < groups.of.size(); ++i) {
        if (groups.of[i] == g) emphasis[static_cast<Eigen::Index>(i)] = 0.0;
      }
    }
    problem.emphasise(std::move(others));
    const FitPoint point = polish(problem, start, prediction_accuracy).point;
    problem.emphasise(all);
    const auto own = static_cast<Eigen::Index>(g);
    scores[own] = group_scores(problem, point, groups)[own];
  }
  return scores;
}

}  // namespace goniofit
