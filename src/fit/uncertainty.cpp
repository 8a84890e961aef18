#include "fit/uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace goniofit {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// `column2`: what a unit step of the parameter changes, squared and summed. No more than `noise2` is no effect at all.
ParameterState state_at(double value, double lower, double upper, double column2, double noise2) {
  const auto near = [value](double bound) {
    return std::isfinite(bound) && std::fabs(value - bound) <= 1e-12 * (1.0 + std::fabs(bound));
  };
  if (lower >= upper) return ParameterState::fixed;
  if (column2 <= noise2) return ParameterState::undetermined;
  if (near(lower)) return ParameterState::at_lower;
  if (near(upper)) return ParameterState::at_upper;
  return ParameterState::free;
}

// The Jacobian of one channel over the free parameters it depends on, and where these stand in the whole.
struct Block {
  Eigen::MatrixXd jacobian;
  std::vector<Eigen::Index> index;
};

class Layout {
 public:
  Layout(const Problem& problem, const FitPoint& point, const Linearisation& l, Uncertainties& out);
  Eigen::Index size = 0;

 private:
  void place(ParameterUncertainty& p) {
    p.u = no_value;
    if (p.state == ParameterState::free) p.index = size++;
  }
};

Layout::Layout(const Problem& problem, const FitPoint& point, const Linearisation& l, Uncertainties& out) {
  // A change of the shape by a factor e that alters the whole scan by less than the residual of one reading: nobody
  // could tell it from no change. Noise-free scans have no residual; what they hold is then known to 1e-8 of their
  // signal.
  const double noise2 =
      std::max(l.loss, 1e-16 * problem.total) / static_cast<double>(problem.samples() * problem.channels.size());
  for (std::size_t z = 0; z < point.z.size(); ++z) {
    double column2 = 0.0;
    for (const Eigen::MatrixXd& shape : l.by_shape) column2 += shape.col(static_cast<Eigen::Index>(z)).squaredNorm();
    place(out.shape.emplace_back(ParameterUncertainty{
        state_at(point.z[z], problem.shape.lower[z], problem.shape.upper[z], column2, noise2), no_value, -1}));
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    std::vector<ParameterUncertainty>& row = out.coefficients.emplace_back();
    for (Eigen::Index j = 0; j < channel.lower.size(); ++j) {
      const double column2 = l.by_coefficient[c].col(j).squaredNorm();
      place(row.emplace_back(ParameterUncertainty{
          state_at(point.coefficients[c][j], channel.lower[j], channel.upper[j], column2, 0.0), no_value, -1}));
    }
    if (!point.optics.empty()) {
      place(out.optics.emplace_back(ParameterUncertainty{
          state_at(point.optics[c], channel.optics_lower, channel.optics_upper, l.by_optics[c].squaredNorm(), 0.0),
          no_value, -1}));
    }
  }
}

// Its columns in the order that Layout placed them.
Block block_of(std::size_t channel, const Linearisation& l, const Uncertainties& u) {
  Block b;
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t z = 0; z < u.shape.size(); ++z) {
    if (u.shape[z].index < 0) continue;
    b.index.push_back(u.shape[z].index);
    columns.emplace_back(l.by_shape[channel].col(static_cast<Eigen::Index>(z)));
  }
  for (std::size_t j = 0; j < u.coefficients[channel].size(); ++j) {
    if (u.coefficients[channel][j].index < 0) continue;
    b.index.push_back(u.coefficients[channel][j].index);
    columns.emplace_back(l.by_coefficient[channel].col(static_cast<Eigen::Index>(j)));
  }
  if (!u.optics.empty() && u.optics[channel].index >= 0) {
    b.index.push_back(u.optics[channel].index);
    columns.push_back(l.by_optics[channel]);
  }
  b.jacobian.resize(l.residuals[channel].size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) b.jacobian.col(static_cast<Eigen::Index>(j)) = columns[j];
  return b;
}

template <class F>
void for_each_parameter(Uncertainties& u, const F& f) {
  for (ParameterUncertainty& p : u.shape) f(p);
  for (auto& row : u.coefficients) {
    for (ParameterUncertainty& p : row) f(p);
  }
  for (ParameterUncertainty& p : u.optics) f(p);
}

void scatter_add(const Eigen::MatrixXd& part, const std::vector<Eigen::Index>& index, Eigen::MatrixXd& whole) {
  for (std::size_t i = 0; i < index.size(); ++i) {
    for (std::size_t j = 0; j < index.size(); ++j) {
      whole(index[i], index[j]) += part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
}

// Parameters that lie in a null direction of the equilibrated normal matrix to double precision.
std::vector<bool> in_null_space(const Eigen::MatrixXd& equilibrated) {
  std::vector<bool> null(static_cast<std::size_t>(equilibrated.rows()), false);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(equilibrated);
  for (Eigen::Index k = 0; k < equilibrated.rows(); ++k) {
    if (eigen.eigenvalues()[k] > 1e-12) break;
    for (Eigen::Index i = 0; i < equilibrated.rows(); ++i) {
      if (std::fabs(eigen.eigenvectors()(i, k)) > 0.1) null[static_cast<std::size_t>(i)] = true;
    }
  }
  return null;
}

// (JᵀJ)⁻¹, equilibrated on the way; false where it is singular.
bool invert(const Eigen::MatrixXd& normal, Eigen::MatrixXd& inverse, Eigen::MatrixXd& equilibrated) {
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  equilibrated = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(equilibrated);
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() <= 1e-12) return false;
  inverse =
      scale.asDiagonal() * ldlt.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())) * scale.asDiagonal();
  return true;
}

// A reading that alone determines a parameter has no residual to speak of, and the parameter no uncertainty to state.
constexpr double full_leverage = 1.0 - 1e-9;

}  // namespace

Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l) {
  Uncertainties out;
  const Layout layout(problem, point, l, out);
  if (layout.size == 0) return out;
  const auto residuals = static_cast<Eigen::Index>(problem.samples() * problem.channels.size());
  std::vector<Block> blocks;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(layout.size, layout.size);
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const Block& b = blocks.emplace_back(block_of(c, l, out));
    scatter_add(b.jacobian.transpose() * b.jacobian, b.index, normal);
  }
  Eigen::MatrixXd bread;
  Eigen::MatrixXd equilibrated;
  if (!invert(normal, bread, equilibrated)) {
    const std::vector<bool> null = in_null_space(equilibrated);
    for_each_parameter(out, [&null](ParameterUncertainty& p) {
      if (p.index >= 0 && null[static_cast<std::size_t>(p.index)]) p.state = ParameterState::undetermined;
      p.index = -1;
    });
    return out;
  }
  if (residuals <= layout.size) return out;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(layout.size, layout.size);
  std::vector<bool> single(static_cast<std::size_t>(layout.size), false);
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    const Block& b = blocks[c];
    const auto width = static_cast<Eigen::Index>(b.index.size());
    Eigen::MatrixXd own(width, width);
    for (Eigen::Index i = 0; i < width; ++i) {
      for (Eigen::Index j = 0; j < width; ++j)
        own(i, j) = bread(b.index[static_cast<std::size_t>(i)], b.index[static_cast<std::size_t>(j)]);
    }
    const Eigen::VectorXd leverage = (b.jacobian * own).cwiseProduct(b.jacobian).rowwise().sum();
    Eigen::VectorXd e2(leverage.size());
    for (Eigen::Index i = 0; i < leverage.size(); ++i) {
      const double left = 1.0 - leverage[i];
      e2[i] = leverage[i] < full_leverage ? (l.residuals[c][i] / left) * (l.residuals[c][i] / left) : 0.0;
      if (leverage[i] < full_leverage) continue;
      for (Eigen::Index j = 0; j < width; ++j) {
        if (b.jacobian(i, j) * b.jacobian(i, j) * own(j, j) > 0.25)
          single[static_cast<std::size_t>(b.index[static_cast<std::size_t>(j)])] = true;
      }
    }
    scatter_add(b.jacobian.transpose() * e2.asDiagonal() * b.jacobian, b.index, meat);
  }
  out.covariance = bread * meat * bread;
  for_each_parameter(out, [&](ParameterUncertainty& p) {
    if (p.index >= 0 && !single[static_cast<std::size_t>(p.index)]) p.u = std::sqrt(out.covariance(p.index, p.index));
  });
  return out;
}

}  // namespace goniofit
