#include "fit/optics_columns.h"

#include <algorithm>

#include "basis/optics.h"

namespace goniofit {

namespace {

// out[i] = weight[i] * factor; `point` maps a row to the pair. Schlick's by loops that the compiler vectorises.
template <class Point>
void fill(OpticsFactor factor, FresnelTier tier, const ChannelOptics& o, const PairBatch& pairs, const Point& point,
          const Eigen::VectorXd& weight, double* out) {
  const auto n = static_cast<std::size_t>(weight.size());
  const double* const w = weight.data();
  const bool schlick = tier == FresnelTier::schlick;
  if (factor == OpticsFactor::one || tier == FresnelTier::none) {
    std::copy_n(w, n, out);
  } else if (schlick && factor == OpticsFactor::fresnel) {
    const double* const from = pairs.one_minus_cos_h.data();
    for (std::size_t i = 0; i < n; ++i) out[i] = w[i] * fresnel_schlick(o.f0, from[point(i)]);
  } else if (schlick && factor == OpticsFactor::transmission) {
    const double* const lit = pairs.cos_i.data();
    const double* const seen = pairs.cos_r.data();
    for (std::size_t i = 0; i < n; ++i) {
      out[i] = w[i] * (transmission_schlick(o.t0, lit[point(i)]) * transmission_schlick(o.t0, seen[point(i)]));
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) out[i] = w[i] * optics_factor(factor, tier, o, pairs[point(i)]);
  }
}

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
    } else {
      fill(factor, problem.terms.fresnel, optics, problem.pairs, point, weight, out.col(column).data());
    }
  }
  return out;
}

}  // namespace

Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics, std::span<const std::size_t> points,
                               const Eigen::VectorXd& weight) {
  return columns_at(problem, optics, weight, [points](std::size_t row) { return points[row]; });
}

Eigen::MatrixXd optics_columns(const Problem& problem, const ChannelOptics& optics) {
  return columns_at(problem, optics, problem.point_weight, [](std::size_t row) { return row; });
}

}  // namespace goniofit
