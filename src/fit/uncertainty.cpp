#include "fit/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

// R of m = QR.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& m) {
  const Eigen::Index rows = std::min(m.rows(), m.cols());
  if (rows == 0) return Eigen::MatrixXd::Zero(0, m.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(m);
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

// The triangle R of J = QR over the whole problem, by way of those of its blocks, its columns scaled to norm 1. Not by
// Cholesky's of JᵀJ, whose condition is the square of J's: with parameters that all but stand in for each other (three
// exponentials, quotients of cubics) half the digits would go.
class Triangle {
 public:
  Triangle(const std::vector<Block>& blocks, Eigen::Index size) : scale_(Eigen::VectorXd::Zero(size)) {
    std::vector<Eigen::MatrixXd> triangles;
    Eigen::Index rows = 0;
    for (const Block& b : blocks) {
      triangles.push_back(triangle_of(b.jacobian));
      rows += triangles.back().rows();
    }
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows, size);
    rows = 0;
    for (std::size_t c = 0; c < blocks.size(); ++c) {
      for (std::size_t j = 0; j < blocks[c].index.size(); ++j) {
        stacked.block(rows, blocks[c].index[j], triangles[c].rows(), 1) =
            triangles[c].col(static_cast<Eigen::Index>(j));
      }
      rows += triangles[c].rows();
    }
    scale_ = stacked.colwise().norm().cwiseInverse();
    r_ = triangle_of(stacked * scale_.asDiagonal());
  }

  /// JᵀJ, its columns scaled.
  [[nodiscard]] Eigen::MatrixXd equilibrated() const { return r_.transpose() * r_; }
  /// Fewer readings than parameters, or dependent columns: the bound is on what is left of a column of norm 1 when
  /// those before it have had their share.
  [[nodiscard]] bool singular() const { return r_.rows() < r_.cols() || !(r_.diagonal().cwiseAbs().minCoeff() > 1e-6); }
  /// B with B Bᵀ = (JᵀJ)⁻¹.
  [[nodiscard]] Eigen::MatrixXd inverse_root() const {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(r_.rows(), r_.cols());
    return scale_.asDiagonal() * r_.triangularView<Eigen::Upper>().solve(identity);
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::MatrixXd r_;
};

// A reading that alone determines a parameter has no residual to speak of, and the parameter no uncertainty to state.
constexpr double full_leverage = 1.0 - 1e-9;

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& m, const std::vector<Eigen::Index>& index) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(index.size()), m.cols());
  for (std::size_t i = 0; i < index.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = m.row(index[i]);
  return rows;
}

// HC3 of all blocks, and which parameters have none because a single reading decides them.
struct Sandwich {
  Eigen::MatrixXd covariance;
  std::vector<bool> single;
};

Sandwich sandwich(const std::vector<Block>& blocks, const Linearisation& l, const Eigen::MatrixXd& root) {
  const Eigen::Index size = root.rows();
  Sandwich out;
  out.single.assign(static_cast<std::size_t>(size), false);
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    const Block& b = blocks[c];
    const Eigen::MatrixXd own = rows_of(root, b.index);
    const Eigen::VectorXd leverage = (b.jacobian * triangle_of(own.transpose()).transpose()).rowwise().squaredNorm();
    Eigen::VectorXd e(leverage.size());
    for (Eigen::Index i = 0; i < leverage.size(); ++i) {
      const bool decides = leverage[i] >= full_leverage;
      e[i] = decides ? 0.0 : l.residuals[c][i] / (1.0 - leverage[i]);
      for (Eigen::Index j = 0; decides && j < own.rows(); ++j) {
        if (b.jacobian(i, j) * b.jacobian(i, j) * own.row(j).squaredNorm() > 0.25)
          out.single[static_cast<std::size_t>(b.index[static_cast<std::size_t>(j)])] = true;
      }
    }
    // In the coordinates of B, and by triangles: nothing is lost to the condition of J squared.
    const Eigen::MatrixXd weighted = triangle_of(e.asDiagonal() * b.jacobian) * own;
    meat.noalias() += weighted.transpose() * weighted;
  }
  out.covariance = root * meat * root.transpose();
  return out;
}

}  // namespace

Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l) {
  Uncertainties out;
  const Layout layout(problem, point, l, out);
  if (layout.size == 0) return out;
  std::vector<Block> blocks;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) blocks.push_back(block_of(c, l, out));
  const Triangle triangle(blocks, layout.size);
  if (triangle.singular()) {
    const std::vector<bool> null = in_null_space(triangle.equilibrated());
    for_each_parameter(out, [&null](ParameterUncertainty& p) {
      if (p.index >= 0 && null[static_cast<std::size_t>(p.index)]) p.state = ParameterState::undetermined;
      p.index = -1;
    });
    return out;
  }
  const Eigen::MatrixXd root = triangle.inverse_root();
  out.covariance_unscaled = root * root.transpose();
  for_each_parameter(out, [&out](ParameterUncertainty& p) {
    if (p.index >= 0) p.u_unscaled = std::sqrt(out.covariance_unscaled(p.index, p.index));
  });
  const auto residuals = static_cast<Eigen::Index>(problem.samples() * problem.channels.size());
  if (residuals <= layout.size) return out;
  out.residual_variance = l.loss / static_cast<double>(residuals - layout.size);
  out.covariance_classical = out.residual_variance * out.covariance_unscaled;
  Sandwich hc3 = sandwich(blocks, l, root);
  out.covariance = std::move(hc3.covariance);
  for_each_parameter(out, [&](ParameterUncertainty& p) {
    if (p.index < 0) return;
    p.u_classical = std::sqrt(out.covariance_classical(p.index, p.index));
    if (!hc3.single[static_cast<std::size_t>(p.index)]) p.u = std::sqrt(out.covariance(p.index, p.index));
  });
  return out;
}

}  // namespace goniofit
