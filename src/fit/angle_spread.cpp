// The cluster-robust spread over incidence angles.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "fit/spread.h"

namespace goniofit {

namespace {

constexpr Eigen::Index replicates = 1999;
constexpr double full_leverage = 1.0 - 1e-9;

struct Cluster {
  Eigen::VectorXd shown;   ///< (1 - G_g)⁻¹ s_g: the scores in the fit without it
  Eigen::MatrixXd gram;    ///< G_g
  Eigen::MatrixXd change;  ///< B (1 - G_g)⁻¹: what leaving the cluster out does to the parameters
};

std::vector<Eigen::Index> rows_of(const AngleGroups& groups, std::size_t g) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < groups.of.size(); ++i) {
    if (groups.of[i] == g) rows.push_back(static_cast<Eigen::Index>(i));
  }
  return rows;
}

// Directions that the cluster alone determines do without it: no other cluster tells how far off it is there.
Cluster cluster_of(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                   const std::vector<Eigen::Index>& rows, std::vector<bool>& single) {
  Cluster out{{}, Eigen::MatrixXd::Zero(j.size(), j.size()), {}};
  Eigen::VectorXd score = Eigen::VectorXd::Zero(j.size());
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    const JacobianBlock& block = j.blocks()[c];
    Eigen::MatrixXd own(static_cast<Eigen::Index>(rows.size()), block.cols());
    for (Eigen::Index p = 0; p < own.cols(); ++p) own.col(p) = block.column(p)(rows);
    const Eigen::MatrixXd u = own * j.own_root(c);
    out.gram.noalias() += u.transpose() * u;
    score.noalias() += u.transpose() * residuals[c](rows);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(out.gram);
  const Eigen::MatrixXd directions = j.root() * eigen.eigenvectors();
  Eigen::VectorXd inverse(j.size());
  for (Eigen::Index k = 0; k < j.size(); ++k) {
    const bool alone = eigen.eigenvalues()[k] >= full_leverage;
    inverse[k] = alone ? 0.0 : 1.0 / (1.0 - eigen.eigenvalues()[k]);
    for (Eigen::Index p = 0; alone && p < j.size(); ++p) {
      if (directions(p, k) * directions(p, k) > 0.25 * j.root().row(p).squaredNorm())
        single[static_cast<std::size_t>(p)] = true;
    }
  }
  const Eigen::MatrixXd without = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  out.shown = without * score;
  out.change = j.root() * without;
  return out;
}

// Six values of mean 0, variance 1 and fourth moment 7/6 (Webb 2014).
double webb_weight(std::mt19937_64& bits) {
  const std::uint64_t draw = bits() % 6;
  const double size = std::sqrt(0.5 * static_cast<double>(1 + draw % 3));
  return draw < 3 ? size : -size;
}

// |t| of each parameter (row) in each replicate. A refit's scores of a cluster are those that the left-out fit shows,
// under a random weight.
Eigen::MatrixXd bootstrap(const JointJacobian& j, const std::vector<Cluster>& clusters) {
  std::mt19937_64 bits(20230131);
  const auto n = static_cast<Eigen::Index>(clusters.size());
  Eigen::MatrixXd shown(j.size(), n);
  for (Eigen::Index g = 0; g < n; ++g) shown.col(g) = clusters[static_cast<std::size_t>(g)].shown;
  Eigen::MatrixXd weights(n, replicates);
  for (double& w : weights.reshaped()) w = webb_weight(bits);
  const Eigen::MatrixXd step = shown * weights;
  Eigen::MatrixXd variance = Eigen::MatrixXd::Zero(step.rows(), step.cols());
  for (Eigen::Index g = 0; g < n; ++g) {
    const Cluster& c = clusters[static_cast<std::size_t>(g)];
    const Eigen::MatrixXd scores = c.shown * weights.row(g) - c.gram * step;
    variance += (c.change * scores).cwiseAbs2();
  }
  variance *= static_cast<double>(n - 1) / static_cast<double>(n);
  return (j.root() * step).cwiseAbs().cwiseQuotient(variance.cwiseSqrt());
}

double quantile(std::vector<double>& values, double probability) {
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(probability * static_cast<double>(values.size() + 1))) - 1;
  const auto at = values.begin() + std::min(rank, static_cast<std::ptrdiff_t>(values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Spread spread_by_angles(const JointJacobian& j, const std::vector<Eigen::VectorXd>& residuals,
                        const AngleGroups& groups) {
  Spread out;
  out.single.assign(static_cast<std::size_t>(j.size()), false);
  std::vector<Cluster> clusters;
  Eigen::MatrixXd changes(j.size(), static_cast<Eigen::Index>(groups.count()));
  for (std::size_t g = 0; g < groups.count(); ++g) {
    const Cluster& c = clusters.emplace_back(cluster_of(j, residuals, rows_of(groups, g), out.single));
    changes.col(static_cast<Eigen::Index>(g)) = j.root() * c.shown;
  }
  const auto n = static_cast<double>(groups.count());
  out.covariance = (n - 1.0) / n * changes * changes.transpose();
  const Eigen::MatrixXd t = bootstrap(j, clusters);
  for (Eigen::Index p = 0; p < j.size(); ++p) {
    std::vector<double> values;
    for (Eigen::Index i = 0; i < t.cols(); ++i) values.push_back(std::isfinite(t(p, i)) ? t(p, i) : 0.0);
    out.k.push_back({std::max(quantile(values, probability_68), coverage_factor(probability_68, n - 1.0)),
                     std::max(quantile(values, probability_95), coverage_factor(probability_95, n - 1.0))});
  }
  return out;
}

}  // namespace goniofit
