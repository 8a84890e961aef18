#include "fit/shape_rows.h"

#include <cmath>
#include <limits>
#include <optional>

namespace goniofit {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ln of a length or of the slope, as value and gradient by z: all three are linear in z.
struct LogLinear {
  double log_value = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();

  friend LogLinear operator+(const LogLinear& a, const LogLinear& b) {
    return {a.log_value + b.log_value, a.gradient + b.gradient};
  }
  friend LogLinear operator-(const LogLinear& a, const LogLinear& b) {
    return {a.log_value - b.log_value, a.gradient - b.gradient};
  }
};

class Rows {
 public:
  Rows(const Problem& problem, const FitPoint& point, const Uncertainties& u)
      : problem_(problem), u_(u), log_shape_(problem.shape.log_shape(point.z.data())) {}
  [[nodiscard]] ShapeRows rows() const;

 private:
  [[nodiscard]] LogLinear shape_parameter(int row) const {
    return {log_shape_[row], problem_.shape.map.row(row).transpose()};
  }
  [[nodiscard]] std::optional<LogLinear> log_sigma() const;
  [[nodiscard]] double standard_uncertainty(const Eigen::Vector2d& gradient) const;
  [[nodiscard]] ParameterState state_of(const Eigen::Vector2d& gradient) const;
  [[nodiscard]] FittedParameter fitted(const char* name, const LogLinear& x, double lower, double upper) const;
  [[nodiscard]] FittedParameter derived(const char* name, const LogLinear& x) const;

  const Problem& problem_;
  const Uncertainties& u_;
  Eigen::Vector2d log_shape_;
};

// Of g · z, by the covariance of z; NaN where a z that it reads has none.
double Rows::standard_uncertainty(const Eigen::Vector2d& gradient) const {
  double variance = 0.0;
  for (int a = 0; a < problem_.shape.free; ++a) {
    if (gradient[a] == 0.0) continue;
    const ParameterUncertainty& pa = u_.shape[static_cast<std::size_t>(a)];
    if (!std::isfinite(pa.u)) return pa.u;
    for (int b = 0; b < problem_.shape.free; ++b) {
      const ParameterUncertainty& pb = u_.shape[static_cast<std::size_t>(b)];
      if (pb.index >= 0) variance += gradient[a] * gradient[b] * u_.covariance(pa.index, pb.index);
    }
  }
  return std::sqrt(variance);
}

ParameterState Rows::state_of(const Eigen::Vector2d& gradient) const {
  ParameterState state = ParameterState::fixed;
  for (int a = 0; a < problem_.shape.free; ++a) {
    const bool known = state != ParameterState::undetermined;
    if (gradient[a] != 0.0 && known) state = u_.shape[static_cast<std::size_t>(a)].state;
  }
  return state;
}

// A parameter that is one of z, or fixed.
FittedParameter Rows::fitted(const char* name, const LogLinear& x, double lower, double upper) const {
  const ShapeMap& map = problem_.shape;
  for (int a = 0; a < map.free; ++a) {
    if (x.gradient[a] == 0.0) continue;
    lower = map.lower_value[static_cast<std::size_t>(a)];
    upper = map.upper_value[static_cast<std::size_t>(a)];
  }
  const double value = std::exp(x.log_value);
  const double u = value * standard_uncertainty(x.gradient);
  FittedParameter p = parameter_row(name, "", value, lower, upper, {state_of(x.gradient), u, -1});
  if (p.fixed) p.u.reset();
  // On a bound the value is the bound, not the exponential of its logarithm.
  if (p.at_lower) p.value = lower;
  if (p.at_upper) p.value = upper;
  return p;
}

// A parameter that follows from others: no bounds of its own.
FittedParameter Rows::derived(const char* name, const LogLinear& x) const {
  FittedParameter p = fitted(name, x, 0.0, infinity);
  p.value = p.value ? std::optional(std::exp(x.log_value)) : std::nullopt;
  p.lower = 0.0;
  p.upper = infinity;
  p.at_lower = p.at_upper = false;
  p.derived = true;
  return p;
}

// Fitted through coh, given, or from a given tau.
std::optional<LogLinear> Rows::log_sigma() const {
  if (problem_.basis->shape_parameters().size() > 1) return shape_parameter(1);
  if (problem_.known_sigma_um) return LogLinear{.log_value = std::log(*problem_.known_sigma_um)};
  if (problem_.known_tau_um) return LogLinear{.log_value = std::log(*problem_.known_tau_um)} + shape_parameter(0);
  return std::nullopt;
}

FittedParameter undetermined_length(const char* name) {
  return parameter_row(name, "", 0.0, 0.0, infinity, {ParameterState::undetermined, infinity, -1});
}

ShapeRows Rows::rows() const {
  const LogLinear slope = shape_parameter(0);
  ShapeRows r{fitted("slope", slope, slope_min, slope_max), undetermined_length("sigma_um"),
              undetermined_length("tau_um")};
  const std::optional<LogLinear> sigma = log_sigma();
  if (sigma && r.slope.value) {
    const bool from_tau = problem_.known_tau_um && !problem_.known_sigma_um;
    r.sigma = from_tau ? derived("sigma_um", *sigma) : fitted("sigma_um", *sigma, 0.0, infinity);
    r.tau = derived("tau_um", *sigma - slope);
    r.tau.derived = !problem_.known_tau_um;
    if (problem_.known_tau_um) r.tau.fixed = true;
    // What was given stands as it was given: rounding must not make the three contradict each other in the file.
    if (problem_.known_sigma_um) r.sigma.value = problem_.known_sigma_um;
    if (problem_.known_tau_um) r.tau.value = problem_.known_tau_um;
    if (!r.sigma.value) r.tau.value.reset();
  }
  r.sigma.unit = r.tau.unit = "um";
  return r;
}

}  // namespace

FittedParameter parameter_row(const std::string& name, const std::string& channel, double value, double lower,
                              double upper, const ParameterUncertainty& u) {
  FittedParameter p;
  p.name = name;
  p.channel = channel;
  if (u.state != ParameterState::undetermined) p.value = value;
  if (std::isfinite(u.u) && p.value) p.u = u.u;
  p.lower = lower;
  p.upper = upper;
  p.fixed = u.state == ParameterState::fixed;
  p.at_lower = u.state == ParameterState::at_lower;
  p.at_upper = u.state == ParameterState::at_upper;
  return p;
}

ShapeRows shape_rows(const Problem& problem, const FitPoint& point, const Uncertainties& u) {
  return Rows(problem, point, u).rows();
}

}  // namespace goniofit
