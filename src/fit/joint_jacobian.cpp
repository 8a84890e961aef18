#include "fit/joint_jacobian.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/dot.h"
#include "fit/triangle.h"

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

// Of the parameters that have a place: the columns of a channel in LinearSums, and their places.
void find_columns(const ParameterPlaces& places, std::size_t channel, std::vector<Eigen::Index>& columns,
                  std::vector<Eigen::Index>& index) {
  Eigen::Index column = 0;
  const auto add = [&](Eigen::Index place) {
    if (place >= 0) {
      columns.push_back(column);
      index.push_back(place);
    }
    ++column;
  };
  for (const Eigen::Index place : places.shape) add(place);
  for (const Eigen::Index place : places.coefficients[channel]) add(place);
  if (!places.optics.empty()) add(places.optics[channel]);
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

// By way of the triangles of the channels. Not by Cholesky's of JᵀJ, whose condition is the square of J's: with
// parameters that all but stand in for each other (three exponentials, quotients of cubics) half the digits would go.
JointJacobian::JointJacobian(const LinearSums& sums, ParameterPlaces places) : places_(std::move(places)) {
  Eigen::Index rows = 0;
  for (std::size_t c = 0; c < sums.triangles.size(); ++c) {
    find_columns(places_, c, columns_.emplace_back(), index_.emplace_back());
    rows += sums.triangles[c].rows();
  }
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows, places_.size);
  rows = 0;
  for (std::size_t c = 0; c < index_.size(); ++c) {
    for (std::size_t j = 0; j < index_[c].size(); ++j)
      stacked.col(index_[c][j]).segment(rows, sums.triangles[c].rows()) = sums.triangles[c].col(columns_[c][j]);
    rows += sums.triangles[c].rows();
  }
  scale_ = stacked.colwise().norm().cwiseInverse();
  r_ = triangle_of(stacked * scale_.asDiagonal());
  if (singular()) return;
  root_ = Eigen::MatrixXd::Identity(r_.rows(), r_.cols());
  r_.triangularView<Eigen::Upper>().solveInPlace(root_);
  root_ = scale_.asDiagonal() * root_;
}

JointJacobian JointJacobian::with_rows(const Linearisation& l) const {
  JointJacobian out = *this;
  out.blocks_.clear();
  for (std::size_t c = 0; c < l.residuals.size(); ++c) out.blocks_.push_back(block_of(c, l, places_));
  return out;
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

Eigen::MatrixXd JointJacobian::own_root(std::size_t channel) const { return root_(index_[channel], Eigen::all); }

Eigen::VectorXd JointJacobian::transposed_times(const std::vector<Eigen::VectorXd>& v) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Eigen::VectorXd own = blocks_[c].transposed_times(v[c]);
    for (std::size_t j = 0; j < blocks_[c].index().size(); ++j)
      out[blocks_[c].index()[j]] += own[static_cast<Eigen::Index>(j)];
  }
  return out;
}

Eigen::VectorXd JointJacobian::gradient(const LinearSums& sums) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
  for (std::size_t c = 0; c < index_.size(); ++c) {
    const Eigen::MatrixXd& triangle = sums.triangles[c];
    for (std::size_t j = 0; j < index_[c].size(); ++j)
      out[index_[c][j]] += triangle.col(columns_[c][j]).dot(triangle.rightCols(1).col(0));
  }
  return out;
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

std::vector<Eigen::VectorXd> times_counts(std::vector<Eigen::VectorXd> v, const Eigen::ArrayXd& count) {
  for (Eigen::VectorXd& own : v) {
    if (count.size() > 0) own.array() *= count;
  }
  return v;
}

void Meat::add(const JointJacobian& j, const std::vector<Eigen::VectorXd>& e) {
  for (std::size_t c = 0; c < triangles_.size(); ++c)
    add_to_triangle(j.blocks()[c].columns(), j.blocks()[c].rows(), e[c].data(), triangles_[c]);
}

Eigen::MatrixXd Meat::of(const JointJacobian& j) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(j.size(), j.size());
  for (std::size_t c = 0; c < triangles_.size(); ++c) {
    const Eigen::MatrixXd weighted = triangles_[c] * j.own_root(c);
    out.noalias() += weighted.transpose() * weighted;
  }
  return out;
}

}  // namespace goniofit
