#include "fit/correlation.h"

#include <algorithm>
#include <cmath>

namespace goniofit {

Correlation correlation_of(const Problem& problem, const Uncertainties& u) {
  Correlation out;
  if (u.covariance.size() == 0) return out;
  std::vector<Eigen::Index> index;
  const auto add = [&](const std::string& name, const ParameterUncertainty& p) {
    if (p.index < 0 || !(p.u > 0.0) || !std::isfinite(p.u)) return;
    out.names.push_back(name);
    index.push_back(p.index);
  };
  for (std::size_t z = 0; z < u.shape.size(); ++z)
    add(problem.basis->shape_parameters()[static_cast<std::size_t>(problem.shape.row[z])].name, u.shape[z]);
  for (std::size_t c = 0; c < u.coefficients.size(); ++c) {
    const std::string prefix = problem.channels[c].name + ".";
    if (!u.optics.empty()) add(prefix + (problem.free_optics == FreeOptics::n ? "n" : "f0"), u.optics[c]);
    for (std::size_t j = 0; j < u.coefficients[c].size(); ++j)
      add(prefix + problem.basis->coefficients()[j].name, u.coefficients[c][j]);
  }
  for (const Eigen::Index a : index) {
    std::vector<double>& row = out.matrix.emplace_back();
    for (const Eigen::Index b : index)
      row.push_back(u.covariance(a, b) / std::sqrt(u.covariance(a, a) * u.covariance(b, b)));
  }
  return out;
}

std::vector<CorrelatedPair> strong_pairs(const Correlation& correlation, double least) {
  std::vector<CorrelatedPair> pairs;
  for (std::size_t a = 0; a < correlation.names.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double rho = correlation.matrix[a][b];
      if (std::fabs(rho) > least) pairs.push_back({b, a, rho});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const CorrelatedPair& a, const CorrelatedPair& b) {
    return std::fabs(a.correlation) > std::fabs(b.correlation);
  });
  return pairs;
}

}  // namespace goniofit
