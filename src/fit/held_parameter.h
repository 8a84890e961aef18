#pragma once
// Any one parameter of a problem that a report has a row of, as a coordinate that can be held: a shape parameter or a
// length that follows from two of them (tau from slope and sigma), a coefficient of one channel, or its free optical
// constant.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "problem.h"
#include "search.h"
#include "uncertainty.h"

namespace goniofit {

/// Which parameter. Its coordinate y is what a fit moves, or a sum of such: of the shape
///
///   value = origin + exp(y),   y = offset + gradient · z,
///
/// of a coefficient or an optical constant the value itself.
struct ParameterChoice {
  enum class Kind : std::uint8_t { shape, coefficient, optics };

  std::string name, channel;  ///< as in FittedParameter
  Kind kind = Kind::shape;
  Eigen::VectorXd gradient{};  ///< of the shape: by z
  double offset = 0.0, origin = 0.0;
  std::size_t channel_index = 0;
  Eigen::Index coefficient = 0;

  [[nodiscard]] double value_of(double y) const;
  /// d value / d y.
  [[nodiscard]] double slope_at(double y) const;
  /// "slope", "R.k_dd".
  [[nodiscard]] std::string key() const { return channel.empty() ? name : channel + "." + name; }
};

/// Every parameter that the problem leaves free, shared ones first, as in the report.
[[nodiscard]] std::vector<ParameterChoice> free_choices(const Problem& problem);

/// A problem in coordinates of which the chosen parameter is one, for as long as this lives; the problem is as before
/// afterwards. A length that follows from two shape parameters takes the place of the first of them.
class HeldParameter {
 public:
  HeldParameter(Problem& problem, ParameterChoice choice);
  ~HeldParameter();
  HeldParameter(const HeldParameter&) = delete;
  HeldParameter& operator=(const HeldParameter&) = delete;

  [[nodiscard]] const ParameterChoice& choice() const noexcept { return choice_; }
  [[nodiscard]] double lower() const noexcept { return lower_; }  ///< bounds of y
  [[nodiscard]] double upper() const noexcept { return upper_; }
  /// y of a point in the coordinates of this.
  [[nodiscard]] double coordinate(const FitPoint& point) const;
  /// A point of the problem as it was, in the coordinates of this.
  [[nodiscard]] FitPoint enter(FitPoint point) const;

  /// Narrows the bounds of y to this one value and moves the point to it and within all bounds.
  void hold(double y, FitPoint& point);
  /// What the data say of y at a point if it had no bounds: a parameter on its bound included.
  [[nodiscard]] ParameterUncertainty unbounded_uncertainty(const FitPoint& point);

 private:
  void set_bounds(double lower, double upper);
  void take_combination();

  Problem& problem_;
  ParameterChoice choice_;
  ShapeMap shape_;                        ///< as it was
  std::vector<ProblemChannel> channels_;  ///< the chosen one as it was; empty of the shape
  std::size_t optics_groups_;
  Eigen::Index place_ = 0;     ///< of y among z
  Eigen::Index partner_ = -1;  ///< the other z of a combination
  double lower_ = 0.0, upper_ = 0.0;
};

}  // namespace goniofit
