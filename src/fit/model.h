#pragma once
// Residuals of a problem and their derivatives by every parameter, free or not. The one place where they are computed:
// the polish, the uncertainties and the derivative tests all read it.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "problem.h"
#include "search.h"

namespace goniofit {

/// [J r]ᵀ[J r] of a channel's residuals r and their derivatives J by the free shape parameters, the coefficients and,
/// where they are free, the optics, in that order; r is last.
struct ChannelEquations {
  Eigen::MatrixXd products;
  double loss = 0.0;
};

class Model {
 public:
  explicit Model(const Problem& problem);

  /// Computes the shape factors at z (problem.shape.free values), with their derivatives if asked for. What follows is
  /// at the shape set last. Nothing is computed again where it is the same.
  void set_shape(const double* z, bool derivatives);
  /// The same for all shape parameters at once, free or not.
  void set_whole_shape(const Eigen::VectorXd& shape, bool derivatives);
  /// Sets the free optical parameter of a channel; needed before the channel is read where the problem leaves it free.
  void set_optics(std::size_t channel, double value);

  /// Fills `out` with one residual a row of the problem, weight * emphasis * (g(model) - g(value)), and returns their
  /// loss: the sum of their squares, or of rho of these. Under a robust kernel each residual comes multiplied by
  /// sqrt(rho'), and so do the derivatives: their products then are the gradient of the loss, and their squares its
  /// Hessian as iteratively reweighted least squares take it; the squares of the residuals sum to no more than the
  /// loss, which is concave in them. The derivatives that follow are those at the k of the last call.
  double residuals(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out);
  /// weight * model, one a row.
  void weighted_values(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out) const;
  /// Sum of the second derivatives of the kernel over that of its slopes, by which reweighting overstates what the
  /// readings say; 1 without a kernel. Of the last call.
  [[nodiscard]] double kernel_share(std::size_t channel) const { return states_[channel].kernel_share; }
  /// d residual / d f and f - value, one a row and both 0 where the value is left out; of the last call, which gave
  /// `residuals`.
  void slopes_and_deviations(std::size_t channel, const Eigen::VectorXd& residuals, Eigen::VectorXd& slopes,
                             Eigen::VectorXd& deviations) const;
  /// d residual / d z[i]; needs set_shape(.., true).
  void by_shape(std::size_t channel, const SmallVector& k, int i, Eigen::Ref<Eigen::VectorXd> out) const;
  /// d residual / d coefficient.
  void by_coefficient(std::size_t channel, const SmallVector& k, std::size_t coefficient,
                      Eigen::Ref<Eigen::VectorXd> out) const;
  /// d residual / d (f0 or n).
  void by_optics(std::size_t channel, const SmallVector& k, Eigen::Ref<Eigen::VectorXd> out) const;
  /// What a step reads of a channel's residuals and derivatives; needs set_shape(.., true).
  [[nodiscard]] ChannelEquations equations(std::size_t channel, const SmallVector& k);

 private:
  /// Shape factors at one wavelength.
  struct Factors {
    double wavelength_um = 1.0;
    Eigen::MatrixXd values;       ///< a column a basis column
    Eigen::MatrixXd derivatives;  ///< column * shape parameters + parameter
  };
  /// Channels of equal optics and equal factors share everything but their readings.
  struct Group {
    std::size_t factors = 0;
    double optics_value = 0.0;
    Eigen::MatrixXd optics;              ///< weight * optics factor, a column a basis column
    Eigen::MatrixXd optics_derivatives;  ///< by the free optical parameter; empty where fixed
    Eigen::MatrixXd products;            ///< optics * shape factor
    Eigen::MatrixXd shape_products;      ///< optics * derivative of the shape factor
    std::vector<double> squares;         ///< add_products of columns_of(group); empty where not yet asked for
  };
  /// What a column is multiplied by: its coefficient, or the square of it.
  [[nodiscard]] double amplitude(Eigen::Index column, const SmallVector& k) const noexcept;
  /// out *= d residual / d (weight * model).
  void emphasise(std::size_t channel, Eigen::Ref<Eigen::VectorXd> out) const;
  double bend(std::size_t channel, Eigen::VectorXd& out);
  void add_columns(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out) const;
  void shape_factors(const Eigen::VectorXd& shape, const PairBatch& pairs, double wavelength_um, bool derivatives,
                     Eigen::MatrixXd& values, Eigen::MatrixXd& by_shape) const;
  std::size_t factors_for(double wavelength_um);
  void fill_optics(std::size_t channel, Group& group) const;
  void multiply_out(Group& group, bool derivatives) const;
  /// The products, then the shape products that are not zero throughout.
  [[nodiscard]] std::vector<const double*> columns_of(const Group& group) const;
  /// What of them makes the derivatives, a column a parameter; columns of equations().
  [[nodiscard]] Eigen::MatrixXd combinations(const SmallVector& k) const;
  [[nodiscard]] ChannelEquations shared_equations(std::size_t channel, const SmallVector& k);

  /// Of a channel, at the coefficients of the last call of residuals().
  struct ChannelState {
    Eigen::VectorXd slope;     ///< d residual / d (weight * model); empty where the emphasis is all of it
    Eigen::VectorXd weighted;  ///< weight * model; empty where the loss is quadratic
    double kernel_share = 1.0;
  };

  const Problem& problem_;
  std::vector<ChannelState> states_;
  Eigen::Index parameters_;
  std::vector<std::size_t> late_rows_;  ///< whose factors read the wavelength; of another wavelength only they differ
  PairBatch late_;
  std::vector<Factors> factors_;
  std::vector<Group> groups_;
  std::vector<std::size_t> group_;  ///< of each channel
  Eigen::VectorXd shape_;           ///< set last; empty where none was
  Eigen::VectorXd scratch_;
  bool have_derivatives_ = false;
};

/// Everything about one point: what uncertainties and optimality are read from.
struct Linearisation {
  std::vector<Eigen::VectorXd> residuals;       ///< one a channel
  std::vector<Eigen::MatrixXd> by_shape;        ///< samples x problem.shape.free
  std::vector<Eigen::MatrixXd> by_coefficient;  ///< samples x coefficients
  std::vector<Eigen::VectorXd> by_optics;       ///< empty where fixed
  std::vector<Eigen::VectorXd> slopes;          ///< d residual / d f, one a row; 0 where the value is left out
  std::vector<Eigen::VectorXd> deviations;      ///< f - value, 1/sr; 0 where it is left out
  double loss = 0.0;
  double kernel_share = 1.0;  ///< Model::kernel_share over all channels
};
[[nodiscard]] Linearisation linearise(const Problem& problem, const FitPoint& point);
/// By a model of that problem, which is left at the point.
[[nodiscard]] Linearisation linearise(const Problem& problem, Model& model, const FitPoint& point);

}  // namespace goniofit
