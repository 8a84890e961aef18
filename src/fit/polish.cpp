#include "fit/polish.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "fit/material_point.h"
#include "fit/model.h"
#include "fit/point_equations.h"

namespace goniofit {

namespace {

// Which of a channel's parameters Ceres moves. Those on a bound that the loss presses against are held there: Ceres
// projects steps onto the box, which creeps along a bound instead of solving on it.
struct ChannelLayout {
  std::vector<std::size_t> coefficients;  ///< free ones
  bool optics = false;                    ///< the optical parameter is free
  std::span<double> x;                    ///< Ceres' parameter block: the coefficients, then the optical parameter

  [[nodiscard]] std::size_t size() const noexcept { return coefficients.size() + (optics ? 1 : 0); }
};

struct State {
  std::vector<std::size_t> moving;  ///< the shape parameters that are not held on a bound
  std::span<double> shape;          ///< Ceres' parameter block of these
  std::vector<ChannelLayout> channels;
  FitPoint point;  ///< what is held fixed, and the result

  State() = default;
  State(State&&) = default;  // a copy's blocks would be the original's

  /// Gives every parameter its place and its value at `point`. All blocks lie in one array: Ceres eliminates them in
  /// the order of their addresses, which apart would be the heap's, and with it the last digit of the result.
  void place_blocks() {
    std::size_t size = moving.size();
    for (const ChannelLayout& layout : channels) size += layout.size();
    storage_.resize(size);
    std::size_t used = 0;
    const auto take = [&](std::size_t n) { return std::span(storage_).subspan(std::exchange(used, used + n), n); };
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ChannelLayout& layout = channels[c];
      layout.x = take(layout.size());
      for (std::size_t i = 0; i < layout.coefficients.size(); ++i) {
        layout.x[i] = point.coefficients[c][static_cast<Eigen::Index>(layout.coefficients[i])];
      }
      if (layout.optics) layout.x.back() = point.optics[c];
    }
    shape = take(moving.size());
    for (std::size_t i = 0; i < moving.size(); ++i) shape[i] = point.z[moving[i]];
  }

  /// Brings the point to where Ceres' parameter blocks are.
  void gather() {
    for (std::size_t i = 0; i < moving.size(); ++i) point.z[moving[i]] = shape[i];
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const ChannelLayout& layout = channels[c];
      for (std::size_t i = 0; i < layout.coefficients.size(); ++i) {
        point.coefficients[c][static_cast<Eigen::Index>(layout.coefficients[i])] = layout.x[i];
      }
      if (layout.optics) point.optics[c] = layout.x.back();
    }
  }

 private:
  std::vector<double> storage_;
};

// All channels at once, with their derivatives always: nearly every point that Ceres tries it goes on from.
class EquationsCallback final : public ceres::EvaluationCallback {
 public:
  EquationsCallback(EquationsAt& equations, State& state) : equations_(equations), state_(state) {}
  void PrepareForEvaluation(bool /*jacobians*/, bool /*new_point*/) override {
    state_.gather();
    equations_.at(state_.point);
  }

 private:
  EquationsAt& equations_;
  State& state_;
};

// All readings of one channel, compressed. A step of Ceres reads the residuals r and the Jacobian J only through |r|²,
// Jᵀr and JᵀJ, so the Cholesky factor of [J r]ᵀ[J r], a triangle of a few rows, serves as well as the thousands of rows
// that it stands for. With those rows the polish takes three times as long (measured on 1439 x 3 readings).
class ChannelCost final : public ceres::CostFunction {
 public:
  ChannelCost(const EquationsAt& equations, const Problem& problem, const State& state, std::size_t channel)
      : equations_(equations),
        problem_(problem),
        free_shape_(static_cast<int>(state.moving.size())),
        state_(state),
        channel_(channel),
        width_(free_shape_ + static_cast<Eigen::Index>(layout().size())) {
    set_num_residuals(static_cast<int>(width_) + 1);
    if (free_shape_ > 0) mutable_parameter_block_sizes()->push_back(free_shape_);
    if (layout().size() > 0) mutable_parameter_block_sizes()->push_back(static_cast<int>(layout().size()));
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals, double** jacobians) const override {
    const ChannelEquations& e = equations_.last().channels[channel_];
    Eigen::Map<Eigen::VectorXd> compressed(residuals, width_ + 1);
    if (jacobians == nullptr) {
      compressed.setZero();
      compressed[width_] = std::sqrt(e.loss);
      return true;
    }
    const Eigen::MatrixXd triangle = compress(e.products);
    compressed = triangle.col(width_);
    // What a robust kernel's loss exceeds the squares by depends on no step: the row that no parameter moves has it.
    if (problem_.robust) compressed[width_] = std::sqrt(std::max(0.0, e.loss - compressed.head(width_).squaredNorm()));
    copy_columns(triangle, 0, free_shape_, free_shape_ > 0 ? jacobians[0] : nullptr);
    copy_columns(triangle, free_shape_, width_ - free_shape_,
                 layout().size() > 0 ? jacobians[free_shape_ > 0 ? 1 : 0] : nullptr);
    return true;
  }

 private:
  [[nodiscard]] const ChannelLayout& layout() const noexcept { return state_.channels[channel_]; }

  // The upper triangle R with RᵀR = [J r]ᵀ[J r], of the parameters that move. A column that depends on those before it
  // gets a row of zeros.
  [[nodiscard]] Eigen::MatrixXd compress(const Eigen::MatrixXd& products) const {
    std::vector<Eigen::Index> at;
    const auto free = static_cast<std::size_t>(problem_.shape.free);
    for (const std::size_t z : state_.moving) at.push_back(static_cast<Eigen::Index>(z));
    for (const std::size_t own : layout().coefficients) at.push_back(static_cast<Eigen::Index>(free + own));
    if (layout().optics) at.push_back(products.cols() - 2);
    at.push_back(products.cols() - 1);
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(width_ + 1, width_ + 1);
    for (Eigen::Index b = 0; b <= width_; ++b) {
      for (Eigen::Index a = 0; a <= b; ++a) {
        const double product = products(at[static_cast<std::size_t>(a)], at[static_cast<std::size_t>(b)]);
        const double rest = product - triangle.col(a).head(a).dot(triangle.col(b).head(a));
        if (a < b) {
          triangle(a, b) = triangle(a, a) > 0.0 ? rest / triangle(a, a) : 0.0;
        } else if (rest > 1e-15 * product || (b == width_ && rest > 0.0)) {
          triangle(b, b) = std::sqrt(rest);
        }
      }
    }
    return triangle;
  }

  void copy_columns(const Eigen::MatrixXd& triangle, Eigen::Index first, Eigen::Index count, double* to) const {
    if (to == nullptr || count == 0) return;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(to, width_ + 1, count) = triangle.middleCols(first, count);
  }

  const EquationsAt& equations_;
  const Problem& problem_;
  int free_shape_;
  const State& state_;
  std::size_t channel_;
  Eigen::Index width_;
};

ceres::Solver::Options solver_options(const Problem& problem, double tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = tolerance;
  options.parameter_tolerance = 1e-11;
  options.gradient_tolerance = 1e-15 * std::max(problem.total, std::numeric_limits<double>::min());
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.minimizer_progress_to_stdout = false;
  return options;
}

void add_bounds(ceres::Problem& ceres_problem, double* block, int index, double lower, double upper) {
  if (std::isfinite(lower)) ceres_problem.SetParameterLowerBound(block, index, lower);
  if (std::isfinite(upper)) ceres_problem.SetParameterUpperBound(block, index, upper);
}

// One Ceres run over what `state` leaves free. Returns whether it converged.
bool run_ceres(const Problem& problem, EquationsAt& equations, State& state, double tolerance,
               std::size_t& iterations) {
  ceres::Problem::Options problem_options;
  EquationsCallback callback(equations, state);
  problem_options.evaluation_callback = &callback;
  ceres::Problem ceres_problem(problem_options);
  ceres::Solver::Options options = solver_options(problem, tolerance);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  const bool shape_is_free = !state.moving.empty();
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    ChannelLayout& layout = state.channels[c];
    std::vector<double*> blocks;
    if (shape_is_free) blocks.push_back(state.shape.data());
    if (layout.size() > 0) blocks.push_back(layout.x.data());
    if (blocks.empty()) continue;
    ceres_problem.AddResidualBlock(new ChannelCost(equations, problem, state, c), nullptr, blocks);
    const ProblemChannel& channel = problem.channels[c];
    for (std::size_t i = 0; i < layout.coefficients.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(layout.coefficients[i]);
      add_bounds(ceres_problem, layout.x.data(), static_cast<int>(i), channel.lower[j], channel.upper[j]);
    }
    if (layout.optics) {
      add_bounds(ceres_problem, layout.x.data(), static_cast<int>(layout.coefficients.size()), channel.optics_lower,
                 channel.optics_upper);
    }
    // The channels' own parameters are eliminated first: what remains couples through the shape alone.
    if (layout.size() > 0) ordering->AddElementToGroup(layout.x.data(), 0);
  }
  if (ceres_problem.NumParameters() == 0) return true;
  if (shape_is_free) {
    ordering->AddElementToGroup(state.shape.data(), 1);
    for (std::size_t i = 0; i < state.moving.size(); ++i) {
      add_bounds(ceres_problem, state.shape.data(), static_cast<int>(i), problem.shape.lower[state.moving[i]],
                 problem.shape.upper[state.moving[i]]);
    }
  }
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  iterations += summary.iterations.size();
  return summary.termination_type == ceres::CONVERGENCE;
}

// How steeply the loss falls with one parameter, as a part of the loss: the square root of what a step could gain by
// the linear model, with the sign of the derivative. A step is taken no longer than `reach`: where a parameter has all
// but no effect the linear model promises the moon. A gain that is round-off of the data (noise-free scans end there)
// is none.
double steepness(double product, double column2, double reach, double loss, double total) {
  if (column2 <= 0.0) return 0.0;
  const double step = std::min(std::fabs(product) / column2, reach);
  const double gain = step * (2.0 * std::fabs(product) - step * column2);
  if (gain <= 1e-20 * total) return 0.0;
  return std::copysign(std::sqrt(gain / loss), product);
}

struct Pressure {
  double steepness;  ///< negative where the loss falls upwards
  bool at_lower, at_upper, fixed;
  /// Whether the loss would fall by moving into the interval.
  [[nodiscard]] bool wants_free(double tolerance) const noexcept {
    if (fixed) return false;
    if (at_lower) return steepness < -tolerance;
    if (at_upper) return steepness > tolerance;
    return true;
  }
};

Pressure coefficient_pressure(const Problem& problem, const PointEquations& e, const FitPoint& p, std::size_t c,
                              std::size_t column) {
  const auto j = static_cast<Eigen::Index>(column);
  const ProblemChannel& channel = problem.channels[c];
  const Eigen::MatrixXd& products = e.channels[c].products;
  const Eigen::Index at = problem.shape.free + j;
  const double k = p.coefficients[c][j];
  return {steepness(products(at, e.residuals()), products(at, at), 1.0 + std::fabs(k), e.loss, problem.total),
          k <= channel.lower[j], k >= channel.upper[j],
          channel.lower[j] >= channel.upper[j] || products(at, at) == 0.0};
}

Pressure optics_pressure(const Problem& problem, const PointEquations& e, const FitPoint& p, std::size_t c) {
  const ProblemChannel& channel = problem.channels[c];
  const Eigen::MatrixXd& products = e.channels[c].products;
  const Eigen::Index at = e.residuals() - 1;
  return {steepness(products(at, at + 1), products(at, at), 1.0, e.loss, problem.total),
          p.optics[c] <= channel.optics_lower, p.optics[c] >= channel.optics_upper,
          channel.optics_lower >= channel.optics_upper || products(at, at) == 0.0};
}

Pressure shape_pressure(const Problem& problem, const PointEquations& e, const FitPoint& p, int z) {
  double product = 0.0;
  double column2 = 0.0;
  for (const ChannelEquations& channel : e.channels) {
    product += channel.products(z, e.residuals());
    column2 += channel.products(z, z);
  }
  const auto i = static_cast<std::size_t>(z);
  return {steepness(product, column2, 1.0, e.loss, problem.total), p.z[i] <= problem.shape.lower[i],
          p.z[i] >= problem.shape.upper[i], problem.shape.lower[i] >= problem.shape.upper[i]};
}

constexpr double release_tolerance = 1e-7;

State layout_for(const Problem& problem, const FitPoint& point, const PointEquations& e) {
  State state;
  state.point = point;
  for (int z = 0; z < problem.shape.free; ++z) {
    if (!shape_pressure(problem, e, point, z).wants_free(release_tolerance)) continue;
    state.moving.push_back(static_cast<std::size_t>(z));
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    ChannelLayout& layout = state.channels.emplace_back();
    for (std::size_t j = 0; j < problem.basis->coefficients().size(); ++j) {
      if (!coefficient_pressure(problem, e, point, c, j).wants_free(release_tolerance)) continue;
      layout.coefficients.push_back(j);
    }
    if (!point.optics.empty() && optics_pressure(problem, e, point, c).wants_free(release_tolerance)) {
      layout.optics = true;
    }
  }
  state.place_blocks();
  return state;
}

// The steepest of the parameters that could still move downhill.
double optimality_of(const Problem& problem, const FitPoint& point, const PointEquations& e) {
  double worst = 0.0;
  const auto look = [&worst](const Pressure& p) {
    if (p.wants_free(0.0)) worst = std::max(worst, std::fabs(p.steepness));
  };
  for (int z = 0; z < problem.shape.free; ++z) look(shape_pressure(problem, e, point, z));
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    for (std::size_t j = 0; j < problem.basis->coefficients().size(); ++j)
      look(coefficient_pressure(problem, e, point, c, j));
    if (!point.optics.empty()) look(optics_pressure(problem, e, point, c));
  }
  return worst;
}

}  // namespace

Polished polish(const Problem& problem, const FitPoint& start, double tolerance) {
  Model model(problem);
  return polish(problem, model, start, tolerance);
}

Polished polish(const Problem& problem, Model& model, const FitPoint& start, double tolerance) {
  Polished result{start, 0, false, 0.0};
  EquationsAt equations(problem, model);
  PointEquations e = equations.at(result.point);
  result.point.loss = e.loss;
  // Each round solves with the bounds that press held fixed; a round after the first is needed only where one was held
  // wrongly or a new one was met.
  for (int round = 0; round < 8; ++round) {
    State state = layout_for(problem, result.point, e);
    const bool converged = run_ceres(problem, equations, state, tolerance, result.iterations);
    state.gather();
    const PointEquations& at_end = equations.at(state.point);
    const double before = result.point.loss;
    if (at_end.loss <= before) {
      result.point = state.point;
      result.point.loss = at_end.loss;
      e = at_end;
    }
    result.optimality = optimality_of(problem, result.point, e);
    result.converged = converged && result.optimality < 1e-5;
    if (result.optimality < 1e-8 || result.point.loss >= before * (1.0 - std::max(tolerance, 1e-13))) break;
  }
  return result;
}

PolishOutcome polish_from(const Scan& scan, const FitSettings& settings, const Material& start, double tolerance) {
  const Problem problem(scan, settings);
  const Polished polished = polish(problem, point_of(problem, start), tolerance);
  PolishOutcome out{polished.point.loss, polished.converged, {}};
  const Eigen::VectorXd end = problem.shape.at(polished.point.z.data());
  for (Eigen::Index i = 0; i < end.size(); ++i) {
    const ShapeParameter& p = problem.basis->shape_parameters()[static_cast<std::size_t>(i)];
    out.shape[p.name] = p.origin + std::exp(end[i]);
  }
  return out;
}

}  // namespace goniofit
