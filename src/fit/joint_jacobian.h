#pragma once
// The Jacobian of a whole problem over some of its parameters, channel by channel: shape parameters are in every
// channel, all others in one.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "model.h"

namespace goniofit {

/// One channel, over the parameters it depends on, and where these stand in the whole. Its columns are those of the
/// linearisation that it was made of, which has to outlive it: of millions of readings a copy is most of the memory.
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
  /// R of diag(weight) J = QR; `weight` may be null for 1.
  [[nodiscard]] Eigen::MatrixXd triangle(const double* weight) const;

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
  /// Requires at least one place. Reads `l` as long as it lives.
  JointJacobian(const Linearisation& l, const ParameterPlaces& places);

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
  /// (JᵀJ)⁻¹ Jᵀ v.
  [[nodiscard]] Eigen::VectorXd solve(const std::vector<Eigen::VectorXd>& v) const;
  /// The leverages J_i (JᵀJ)⁻¹ J_iᵀ of a channel's readings.
  [[nodiscard]] Eigen::VectorXd leverages(std::size_t channel) const;
  /// Σ of [diag(e) J B]ᵀ [diag(e) J B] over the channels: B times it times Bᵀ is (JᵀJ)⁻¹ Jᵀ diag(e²) J (JᵀJ)⁻¹. By
  /// triangles: nothing is lost to the condition of J squared.
  [[nodiscard]] Eigen::MatrixXd meat(const std::vector<Eigen::VectorXd>& e) const;
  /// The same of e² = `variance` by products: half the digits are lost to a bad condition, and it costs a tenth.
  [[nodiscard]] Eigen::MatrixXd rough_meat(const std::vector<Eigen::VectorXd>& variance) const;
  /// J_i C J_iᵀ of a channel's readings, C = S Sᵀ over all parameters given by its root S.
  [[nodiscard]] Eigen::VectorXd variances_by(std::size_t channel, const Eigen::MatrixXd& s) const;

 private:
  std::vector<JacobianBlock> blocks_;
  Eigen::VectorXd scale_;
  Eigen::MatrixXd r_;  ///< of J = QR, J's columns scaled to norm 1
  Eigen::MatrixXd root_;
};

}  // namespace goniofit
