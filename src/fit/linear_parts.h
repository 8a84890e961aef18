#pragma once
// A problem linearised at a point: its rows, all of them or part by part, and what sums over them say.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "model.h"
#include "problem.h"
#include "search.h"
#include "whitening.h"

namespace goniofit {

/// A view: problem, point and linearisation have to outlive it.
class LinearParts {
 public:
  /// Of a problem in one piece, by its linearisation.
  LinearParts(const Problem& problem, const FitPoint& point, const Linearisation& l)
      : problem_(problem), point_(point), whole_(l) {}

  using Visit = std::function<void(const Problem& part, const Linearisation& l)>;
  /// Of a problem by parts each is linearised for the visit, and forgotten.
  void for_each(const Visit& visit) const;
  /// Readings that stand for all, each for factor² of them (thinning.h); of a problem in one piece all, and no factors.
  using VisitSome = std::function<void(const Problem& part, const Linearisation& l, const std::vector<double>& factor)>;
  void visit_drawn(const VisitSome& visit) const;

  [[nodiscard]] const Problem& problem() const noexcept { return problem_; }
  [[nodiscard]] const FitPoint& point() const noexcept { return point_; }
  /// Linearisation::kernel_share.
  [[nodiscard]] double kernel_share() const noexcept { return problem_.by_parts() ? 1.0 : whole_.kernel_share; }

 private:
  const Problem& problem_;
  const FitPoint& point_;
  const Linearisation& whole_;
};

/// The noise of the readings, from at most a thousand of each channel.
[[nodiscard]] NoiseModel noise_model(const LinearParts& parts);

/// Over all rows.
struct LinearSums {
  /// R of [J r] = QR, one a channel: the residuals' derivatives by the free shape parameters, the coefficients and,
  /// where they are free, the optics, then the residuals. Norms and products of columns are those of R's.
  std::vector<Eigen::MatrixXd> triangles;
  std::vector<Eigen::MatrixXd> whitened;  ///< the same of rows in units of their noise; empty where none was given
  /// Of a channel's readings used: their number, and sums of squared differences from the model.
  struct Differences {
    double values = 0.0, squares = 0.0, cosine_squares = 0.0;
  };
  std::vector<Differences> differences;
  double loss = 0.0;
};
/// `noise` may be null.
[[nodiscard]] LinearSums linear_sums(const LinearParts& parts, const NoiseModel* noise);

}  // namespace goniofit
