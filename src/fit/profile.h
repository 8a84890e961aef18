#pragma once
// The loss as a function of the shape parameters alone, the coefficients solved inside.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "coefficient_solve.h"
#include "problem.h"
#include "search.h"
#include "thinning.h"

namespace goniofit {

class Profile {
 public:
  /// Over the rows selected.
  explicit Profile(const Problem& problem, RowSelection selection = {});

  /// The profile at z (problem.shape.free values). Work that depends on z[0] alone is kept from the call before.
  [[nodiscard]] double loss(const double* z);
  /// The same with the point itself.
  [[nodiscard]] FitPoint point(const double* z);
  [[nodiscard]] std::size_t evaluations() const noexcept { return evaluations_; }

 private:
  /// Residuals whose shape factors are computed together.
  struct Part {
    PairBatch pairs;  ///< of the late part; the early one's are in its blocks
    Eigen::VectorXd point_weight;
    RowSums sums;
    std::vector<std::size_t> points, rows;  ///< of the problem
    std::vector<double> factor;             ///< of each row
    std::vector<Eigen::VectorXd> target;    ///< one a channel; with its emphasis
    std::vector<Eigen::VectorXd> emphasis;  ///< likewise; empty where it is 1 throughout
  };
  /// Early points evaluated together, few enough for the cache. A reading a point but for the last block, which holds
  /// the sums too.
  struct Block {
    PairBatch pairs;
    Eigen::Index first_point = 0, first_row = 0, rows = 0;
    double onset = 0.0;  ///< z[0] up to which nothing here reads the shape
  };
  /// A value of the optics that a group of channels may take; one where they are fixed.
  struct Candidate {
    double value = 0.0;             ///< of the free optical parameter
    Eigen::MatrixXd early, late;    ///< point weight * optics factor, a column a basis column
    std::vector<SmallMatrix> gram;  ///< of the early rows; one for all channels of the group where none has an emphasis
    Eigen::MatrixXd rhs;            ///< column a channel of the group
    /// The same of the columns that do not read the shape, over each block and all that follow.
    std::vector<std::vector<SmallMatrix>> dark_gram;
    std::vector<Eigen::MatrixXd> dark_rhs;
  };
  struct Group {
    std::vector<std::size_t> channels;
    std::vector<Candidate> candidates;
  };
  struct Choice {
    CoefficientSolver::Solution solution;
    double loss = 0.0, optics = 0.0;
  };

  void divide();
  void take(std::size_t row, std::size_t first_point, double factor, Part& part) const;
  void fill(Part& part) const;
  void sort_by_onset();
  void cut_into_blocks();
  void add_dark_equations();
  void add_block(const Block& block, const Group& group, const Candidate& candidate, std::vector<SmallMatrix>& gram,
                 Eigen::MatrixXd& rhs);
  void add_group(std::size_t index);
  void reset_early_equations();
  void update_early(const Eigen::VectorXd& shape);
  void add_equations(const Part& part, std::size_t channel, Eigen::Index first_row, const Eigen::MatrixXd& columns,
                     SmallMatrix* gram, Eigen::Ref<Eigen::VectorXd> rhs) const;
  [[nodiscard]] Choice choose_from(std::size_t channel, const Group& group, std::size_t position,
                                   const Eigen::MatrixXd& late_shape) const;

  const Problem& problem_;
  std::size_t columns_;
  CoefficientSolver solver_;
  RowSelection selection_;
  // Rows whose factors do not read the length come first ("early"); those that do ("late") are few, or all of them.
  // Where the loss is not quadratic no equations are kept, and all rows are late, in the problem's order.
  // Early rows stand in the order of their onsets, where the basis knows these.
  Part early_, late_;
  std::vector<Block> blocks_;
  bool emphasised_ = false;      ///< some channel has an emphasis
  std::vector<double> target2_;  ///< squared norm of each channel's target
  std::vector<Group> groups_;
  Eigen::MatrixXd early_shape_, product_;
  Eigen::VectorXd early_at_;  ///< shape parameters that early_shape_ is of; empty at first
  std::size_t evaluations_ = 0;
};

}  // namespace goniofit
