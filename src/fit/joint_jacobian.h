#pragma once
// The Jacobian of a whole problem over some of its parameters, channel by channel: shape parameters are in every
// channel, all others in one.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "linear_parts.h"
#include "model.h"

namespace goniofit {

/// Rows of one channel, over the parameters it depends on, and where these stand in the whole. Its columns are those of
/// the linearisation that it was made of, which has to outlive it.
class JacobianBlock {
 public:
  explicit JacobianBlock(Eigen::Index rows) : rows_(rows) {}
  void add(Eigen::Index place, const double* column) {
    index_.push_back(place);
    columns_.push_back(column);
  }

  [[nodiscard]] const std::vector<Eigen::Index>& index() const noexcept { return index_; }
  [[nodiscard]] const std::vector<const double*>& columns() const noexcept { return columns_; }
  [[nodiscard]] Eigen::Index rows() const noexcept { return rows_; }
  [[nodiscard]] Eigen::Index cols() const noexcept { return static_cast<Eigen::Index>(columns_.size()); }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> column(Eigen::Index p) const {
    return {columns_[static_cast<std::size_t>(p)], rows_};
  }
  [[nodiscard]] Eigen::RowVectorXd row(Eigen::Index i) const;
  [[nodiscard]] Eigen::VectorXd times(const Eigen::VectorXd& by) const;
  [[nodiscard]] Eigen::VectorXd transposed_times(const Eigen::VectorXd& v) const;

 private:
  Eigen::Index rows_;
  std::vector<Eigen::Index> index_;
  std::vector<const double*> columns_;
};

/// Places of the parameters in the whole; -1 where left out.
struct ParameterPlaces {
  std::vector<Eigen::Index> shape;
  std::vector<std::vector<Eigen::Index>> coefficients;  ///< [channel][coefficient]
  std::vector<Eigen::Index> optics;                     ///< [channel]; empty where fixed
  Eigen::Index size = 0;
};

class JointJacobian {
 public:
  /// Of all rows, by what LinearSums keeps of them. Requires at least one place.
  JointJacobian(const LinearSums& sums, ParameterPlaces places);
  /// The same with rows, all or a part of them: what is said of blocks, and sums over rows, is of these. It reads `l`
  /// as long as it lives.
  [[nodiscard]] JointJacobian with_rows(const Linearisation& l) const;

  [[nodiscard]] const std::vector<JacobianBlock>& blocks() const noexcept { return blocks_; }
  [[nodiscard]] Eigen::Index size() const noexcept { return scale_.size(); }
  /// Fewer readings than parameters, or dependent columns: the bound is on what is left of a column of norm 1 when
  /// those before it have had their share.
  [[nodiscard]] bool singular() const;
  /// Parameters that lie in a null direction of JᵀJ to double precision.
  [[nodiscard]] std::vector<bool> in_null_space() const;
  /// B with B Bᵀ = (JᵀJ)⁻¹; not for a singular one.
  [[nodiscard]] const Eigen::MatrixXd& root() const noexcept { return root_; }
  /// Its rows of the parameters that a channel depends on.
  [[nodiscard]] Eigen::MatrixXd own_root(std::size_t channel) const;
  /// Jᵀ v, v one vector a channel.
  [[nodiscard]] Eigen::VectorXd transposed_times(const std::vector<Eigen::VectorXd>& v) const;
  /// Jᵀ r of all rows, r the residuals.
  [[nodiscard]] Eigen::VectorXd gradient(const LinearSums& sums) const;
  /// (JᵀJ)⁻¹ by.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& by) const { return root_ * (root_.transpose() * by); }
  /// The leverages J_i (JᵀJ)⁻¹ J_iᵀ of a channel's readings.
  [[nodiscard]] Eigen::VectorXd leverages(std::size_t channel) const;
  /// Σ of [diag(e) J B]ᵀ [diag(e) J B] over the channels, e² = `variance`: B times it times Bᵀ is
  /// (JᵀJ)⁻¹ Jᵀ diag(e²) J (JᵀJ)⁻¹. By products: half the digits are lost to a bad condition, and it costs a tenth of
  /// what Meat does.
  [[nodiscard]] Eigen::MatrixXd rough_meat(const std::vector<Eigen::VectorXd>& variance) const;
  /// J_i C J_iᵀ of a channel's readings, C = S Sᵀ over all parameters given by its root S.
  [[nodiscard]] Eigen::VectorXd variances_by(std::size_t channel, const Eigen::MatrixXd& s) const;

 private:
  ParameterPlaces places_;
  std::vector<std::vector<Eigen::Index>> columns_, index_;  ///< [channel]: in LinearSums, and in the whole
  std::vector<JacobianBlock> blocks_;
  Eigen::VectorXd scale_;
  Eigen::MatrixXd r_;  ///< of J = QR, J's columns scaled to norm 1
  Eigen::MatrixXd root_;
};

/// v[c][i] * count[i], or v where there are no counts: sums over readings that stand for others.
[[nodiscard]] std::vector<Eigen::VectorXd> times_counts(std::vector<Eigen::VectorXd> v, const Eigen::ArrayXd& count);

/// JointJacobian::rough_meat by triangles, of all rows: nothing is lost to the condition of J squared.
class Meat {
 public:
  explicit Meat(std::size_t channels) : triangles_(channels) {}
  /// `e` one vector a channel, each as long as the rows that `j` has.
  void add(const JointJacobian& j, const std::vector<Eigen::VectorXd>& e);
  [[nodiscard]] Eigen::MatrixXd of(const JointJacobian& j) const;

 private:
  std::vector<Eigen::MatrixXd> triangles_;
};

}  // namespace goniofit
