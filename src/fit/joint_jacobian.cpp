#include "fit/joint_jacobian.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "fit/dot.h"

namespace goniofit {

namespace {

JacobianBlock block_of(std::size_t channel, const Linearisation& l, const ParameterPlaces& places) {
  JacobianBlock b;
  const Eigen::Index rows = l.residuals[channel].size();
  std::vector<const double*> columns;
  const auto add = [&](Eigen::Index place, const double* column) {
    if (place < 0) return;
    b.index.push_back(place);
    columns.push_back(column);
  };
  for (std::size_t z = 0; z < places.shape.size(); ++z)
    add(places.shape[z], l.by_shape[channel].col(static_cast<Eigen::Index>(z)).data());
  for (std::size_t j = 0; j < places.coefficients[channel].size(); ++j)
    add(places.coefficients[channel][j], l.by_coefficient[channel].col(static_cast<Eigen::Index>(j)).data());
  if (!places.optics.empty()) add(places.optics[channel], l.by_optics[channel].data());
  b.jacobian.resize(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j)
    b.jacobian.col(static_cast<Eigen::Index>(j)) = Eigen::Map<const Eigen::VectorXd>(columns[j], rows);
  return b;
}

std::vector<const double*> columns_of(const Eigen::MatrixXd& m) {
  std::vector<const double*> columns;
  for (Eigen::Index j = 0; j < m.cols(); ++j) columns.push_back(m.col(j).data());
  return columns;
}

// R of m = QR.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& m) {
  const Eigen::Index rows = std::min(m.rows(), m.cols());
  if (rows == 0) return Eigen::MatrixXd::Zero(0, m.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(m);
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

}  // namespace

// By way of the triangles of the blocks. Not by Cholesky's of JᵀJ, whose condition is the square of J's: with
// parameters that all but stand in for each other (three exponentials, quotients of cubics) half the digits would go.
JointJacobian::JointJacobian(const Linearisation& l, const ParameterPlaces& places) {
  std::vector<Eigen::MatrixXd> triangles;
  Eigen::Index rows = 0;
  for (std::size_t c = 0; c < l.residuals.size(); ++c) {
    blocks_.push_back(block_of(c, l, places));
    triangles.push_back(triangle_of(blocks_.back().jacobian));
    rows += triangles.back().rows();
  }
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows, places.size);
  rows = 0;
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    for (std::size_t j = 0; j < blocks_[c].index.size(); ++j) {
      stacked.block(rows, blocks_[c].index[j], triangles[c].rows(), 1) = triangles[c].col(static_cast<Eigen::Index>(j));
    }
    rows += triangles[c].rows();
  }
  scale_ = stacked.colwise().norm().cwiseInverse();
  r_ = triangle_of(stacked * scale_.asDiagonal());
  if (singular()) return;
  root_ = Eigen::MatrixXd::Identity(r_.rows(), r_.cols());
  r_.triangularView<Eigen::Upper>().solveInPlace(root_);
  root_ = scale_.asDiagonal() * root_;
}

bool JointJacobian::singular() const { return r_.rows() < r_.cols() || !(r_.diagonal().cwiseAbs().minCoeff() > 1e-6); }

std::vector<bool> JointJacobian::in_null_space() const {
  const Eigen::MatrixXd equilibrated = r_.transpose() * r_;
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

Eigen::MatrixXd JointJacobian::own_root(std::size_t channel) const { return root_(blocks_[channel].index, Eigen::all); }

Eigen::VectorXd JointJacobian::transposed_times(const std::vector<Eigen::VectorXd>& v) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Eigen::VectorXd own = blocks_[c].jacobian.transpose() * v[c];
    for (std::size_t j = 0; j < blocks_[c].index.size(); ++j)
      out[blocks_[c].index[j]] += own[static_cast<Eigen::Index>(j)];
  }
  return out;
}

Eigen::VectorXd JointJacobian::solve(const std::vector<Eigen::VectorXd>& v) const {
  return root_ * (root_.transpose() * transposed_times(v));
}

Eigen::VectorXd JointJacobian::leverages(std::size_t channel) const { return variances_by(channel, root_); }

Eigen::VectorXd JointJacobian::variances_by(std::size_t channel, const Eigen::MatrixXd& s) const {
  const JacobianBlock& b = blocks_[channel];
  const Eigen::MatrixXd own = s(b.index, Eigen::all);
  const Eigen::MatrixXd root = triangle_of(own.transpose()).transpose();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(b.jacobian.rows());
  const std::vector<const double*> columns = columns_of(b.jacobian);
  add_squared_norms(columns.data(), columns.size(), root.data(), static_cast<std::size_t>(root.cols()),
                    static_cast<std::size_t>(out.size()), out.data());
  return out;
}

Eigen::MatrixXd JointJacobian::rough_meat(const std::vector<Eigen::VectorXd>& variance) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Eigen::MatrixXd& jacobian = blocks_[c].jacobian;
    const std::vector<const double*> columns = columns_of(jacobian);
    std::vector<double> packed(columns.size() * (columns.size() + 1) / 2, 0.0);
    add_weighted_products(columns.data(), columns.size(), variance[c].data(), static_cast<std::size_t>(jacobian.rows()),
                          packed.data());
    Eigen::MatrixXd products(jacobian.cols(), jacobian.cols());
    const double* from = packed.data();
    for (Eigen::Index p = 0; p < jacobian.cols(); ++p) {
      for (Eigen::Index q = 0; q <= p; ++q) products(q, p) = products(p, q) = *from++;
    }
    const Eigen::MatrixXd own = own_root(c);
    out.noalias() += own.transpose() * (products * own);
  }
  return out;
}

Eigen::MatrixXd JointJacobian::meat(const std::vector<Eigen::VectorXd>& e) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Eigen::MatrixXd weighted = triangle_of(e[c].asDiagonal() * blocks_[c].jacobian) * own_root(c);
    out.noalias() += weighted.transpose() * weighted;
  }
  return out;
}

}  // namespace goniofit
