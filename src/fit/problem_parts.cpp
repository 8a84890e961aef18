// Problems of very many readings, a part of them at a time.

#include <algorithm>
#include <numeric>

#include "fit/problem.h"

namespace goniofit {

namespace {

// `which` ascends.
Eigen::VectorXd some_of(const Eigen::VectorXd& all, const std::vector<std::size_t>& which) {
  if (all.size() == 0 || which.empty()) return {};
  const std::size_t first = which.front();
  if (which.back() - first + 1 == which.size())
    return all.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(which.size()));
  Eigen::VectorXd out(static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = all[static_cast<Eigen::Index>(which[i])];
  return out;
}

ProblemChannel part_of(const ProblemChannel& whole, const std::vector<std::size_t>& which,
                       const Eigen::VectorXd& weight) {
  ProblemChannel out;
  static_cast<ChannelTerms&>(out) = whole;
  out.value = some_of(whole.value, which);
  out.target = weight.cwiseProduct(out.value);
  out.u = some_of(whole.u, which);
  out.used = some_of(whole.used, which);
  out.emphasis = some_of(whole.emphasis, which);
  return out;
}

}  // namespace

// A basis of its own: they remember what they computed for the pairs of one problem.
Problem Problem::part(const std::vector<std::size_t>& of_readings) const {
  Problem out{static_cast<const ProblemTerms&>(*this)};
  out.make_basis();
  std::vector<AnglePair> angles;
  angles.reserve(of_readings.size());
  out.rows.reserve(of_readings.size());
  out.theta_i_deg.reserve(of_readings.size());
  for (const std::size_t i : of_readings) {
    angles.push_back(angles_[i]);
    out.rows.push_back(rows[i]);
    out.theta_i_deg.push_back(angles_[i].theta_i_deg);
  }
  out.pairs = PairBatch(angles);
  out.sums = RowSums(of_readings.size());
  out.point_weight = out.weight = some_of(weight, of_readings);
  for (const ProblemChannel& c : channels) out.channels.push_back(part_of(c, of_readings, out.weight));
  return out;
}

Problem Problem::run(std::size_t first) const {
  std::vector<std::size_t> which(std::min(part_size, readings() - first));
  std::iota(which.begin(), which.end(), first);
  return part(which);
}

PairBatch Problem::pairs_of_run(std::size_t first) const {
  const auto begin = angles_.begin() + static_cast<std::ptrdiff_t>(first);
  return PairBatch({begin, begin + static_cast<std::ptrdiff_t>(std::min(part_size, readings() - first))});
}

}  // namespace goniofit
