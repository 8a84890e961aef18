#include "fit/joint_jacobian.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "fit/dot.h"

namespace goniofit {

namespace {

JacobianBlock block_of(std::size_t channel, const Linearisation& l, const ParameterPlaces& places) {
  JacobianBlock b(l.residuals[channel].size());
  const auto add = [&b](Eigen::Index place, const double* column) {
    if (place >= 0) b.add(place, column);
  };
  for (std::size_t z = 0; z < places.shape.size(); ++z)
    add(places.shape[z], l.by_shape[channel].col(static_cast<Eigen::Index>(z)).data());
  for (std::size_t j = 0; j < places.coefficients[channel].size(); ++j)
    add(places.coefficients[channel][j], l.by_coefficient[channel].col(static_cast<Eigen::Index>(j)).data());
  if (!places.optics.empty()) add(places.optics[channel], l.by_optics[channel].data());
  return b;
}

// R of m = QR.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& m) {
  const Eigen::Index rows = std::min(m.rows(), m.cols());
  if (rows == 0) return Eigen::MatrixXd::Zero(0, m.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(m);
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

}  // namespace

Eigen::RowVectorXd JacobianBlock::row(Eigen::Index i) const {
  Eigen::RowVectorXd out(cols());
  for (Eigen::Index p = 0; p < cols(); ++p) out[p] = columns_[static_cast<std::size_t>(p)][i];
  return out;
}

Eigen::VectorXd JacobianBlock::times(const Eigen::VectorXd& by) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows_);
  for (std::size_t p = 0; p < columns_.size(); ++p)
    add_scaled(by[static_cast<Eigen::Index>(p)], columns_[p], out.data(), static_cast<std::size_t>(rows_));
  return out;
}

Eigen::VectorXd JacobianBlock::transposed_times(const Eigen::VectorXd& v) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(cols());
  add_products_with(columns_.data(), columns_.size(), v.data(), static_cast<std::size_t>(rows_), out.data());
  return out;
}

// Of so many rows at a time, each on top of them the triangle of those before: they stay in the cache.
Eigen::MatrixXd JacobianBlock::triangle(const double* weight) const {
  constexpr Eigen::Index at_once = 512;
  Eigen::MatrixXd r(0, cols());
  for (Eigen::Index first = 0; first < rows_; first += at_once) {
    const Eigen::Index count = std::min(at_once, rows_ - first);
    Eigen::MatrixXd part(r.rows() + count, cols());
    part.topRows(r.rows()) = r;
    for (Eigen::Index p = 0; p < cols(); ++p) part.col(p).tail(count) = column(p).segment(first, count);
    if (weight != nullptr)
      part.bottomRows(count).array().colwise() *= Eigen::Map<const Eigen::ArrayXd>(weight + first, count);
    r = triangle_of(part);
  }
  return r;
}

// By way of the triangles of the blocks. Not by Cholesky's of JᵀJ, whose condition is the square of J's: with
// parameters that all but stand in for each other (three exponentials, quotients of cubics) half the digits would go.
JointJacobian::JointJacobian(const Linearisation& l, const ParameterPlaces& places) {
  std::vector<Eigen::MatrixXd> triangles;
  Eigen::Index rows = 0;
  for (std::size_t c = 0; c < l.residuals.size(); ++c) {
    blocks_.push_back(block_of(c, l, places));
    triangles.push_back(blocks_.back().triangle(nullptr));
    rows += triangles.back().rows();
  }
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows, places.size);
  rows = 0;
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    for (std::size_t j = 0; j < blocks_[c].index().size(); ++j) {
      stacked.block(rows, blocks_[c].index()[j], triangles[c].rows(), 1) =
          triangles[c].col(static_cast<Eigen::Index>(j));
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

Eigen::MatrixXd JointJacobian::own_root(std::size_t channel) const {
  return root_(blocks_[channel].index(), Eigen::all);
}

Eigen::VectorXd JointJacobian::transposed_times(const std::vector<Eigen::VectorXd>& v) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Eigen::VectorXd own = blocks_[c].transposed_times(v[c]);
    for (std::size_t j = 0; j < blocks_[c].index().size(); ++j)
      out[blocks_[c].index()[j]] += own[static_cast<Eigen::Index>(j)];
  }
  return out;
}

Eigen::VectorXd JointJacobian::solve(const std::vector<Eigen::VectorXd>& v) const {
  return root_ * (root_.transpose() * transposed_times(v));
}

Eigen::VectorXd JointJacobian::leverages(std::size_t channel) const { return variances_by(channel, root_); }

Eigen::VectorXd JointJacobian::variances_by(std::size_t channel, const Eigen::MatrixXd& s) const {
  const JacobianBlock& b = blocks_[channel];
  const Eigen::MatrixXd own = s(b.index(), Eigen::all);
  const Eigen::MatrixXd root = triangle_of(own.transpose()).transpose();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(b.rows());
  add_squared_norms(b.columns().data(), b.columns().size(), root.data(), static_cast<std::size_t>(root.cols()),
                    static_cast<std::size_t>(out.size()), out.data());
  return out;
}

Eigen::MatrixXd JointJacobian::rough_meat(const std::vector<Eigen::VectorXd>& variance) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const std::vector<const double*>& columns = blocks_[c].columns();
    const auto width = static_cast<Eigen::Index>(columns.size());
    std::vector<double> packed(columns.size() * (columns.size() + 1) / 2, 0.0);
    add_weighted_products(columns.data(), columns.size(), variance[c].data(),
                          static_cast<std::size_t>(blocks_[c].rows()), packed.data());
    Eigen::MatrixXd products(width, width);
    const double* from = packed.data();
    for (Eigen::Index p = 0; p < width; ++p) {
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
    const Eigen::MatrixXd weighted = blocks_[c].triangle(e[c].data()) * own_root(c);
    out.noalias() += weighted.transpose() * weighted;
  }
  return out;
}

}  // namespace goniofit
