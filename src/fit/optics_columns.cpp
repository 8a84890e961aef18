#include "fit/optics_columns.h"

#include <algorithm>

#include "basis/optics.h"

namespace goniofit {

namespace {

// What the factors read of a pair.
Pair cosines_of(const PairBatch& pairs, std::size_t i) {
  Pair p{};
  p.cos_i = pairs.cos_i[i];
  p.cos_r = pairs.cos_r[i];
  p.one_minus_cos_i = pairs.one_minus_cos_i[i];
  p.one_minus_cos_r = pairs.one_minus_cos_r[i];
  p.cos_h = pairs.cos_h[i];
  p.one_minus_cos_h = pairs.one_minus_cos_h[i];
  return p;
}

// `point` maps a row to the pair.
template <class Point>
Eigen::MatrixXd columns_at(const Problem& problem, const ChannelOptics& optics, const Eigen::VectorXd& weight,
                           const Point& point) {
  const std::vector<BasisColumn>& columns = problem.basis->columns();
  Eigen::MatrixXd out(weight.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const OpticsFactor factor = columns[j].optics;
    const auto twin = std::find_if(columns.begin(), columns.begin() + column,
                                   [factor](const BasisColumn& other) { return other.optics == factor; });
    if (twin != columns.begin() + column) {
      out.col(column) = out.col(twin - columns.begin());
    } else if (factor == OpticsFactor::one) {
      out.col(column) = weight;
    } else {
      for (Eigen::Index i = 0; i < weight.size(); ++i) {
        const Pair p = cosines_of(problem.pairs, point(static_cast<std::size_t>(i)));
        out(i, column) = weight[i] * optics_factor(factor, problem.terms.fresnel, optics, p);
      }
    }
  }
  return out;
}

}  // namespace

Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics,
                               std::span<const std::size_t> points, const Eigen::VectorXd& weight) {
  return columns_at(problem, optics, weight, [points](std::size_t row) { return points[row]; });
}

Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics) {
  return columns_at(problem, optics, problem.point_weight, [](std::size_t row) { return row; });
}

}  // namespace goniofit
