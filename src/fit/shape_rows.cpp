#include "fit/shape_rows.h"

#include <cmath>
#include <limits>
#include <optional>

#include "fit/intervals.h"

namespace goniofit {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ln of a shape parameter (less its origin), or of a product of such, as value and gradient by z: all linear in z.
struct LogLinear {
  double log_value = 0.0;
  Eigen::VectorXd gradient;

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
      : problem_(problem), u_(u), z_(problem.shape.at(point.z.data())) {}
  [[nodiscard]] std::vector<FittedParameter> rows() const;

 private:
  [[nodiscard]] LogLinear shape_parameter(std::size_t i) const {
    const auto row = static_cast<Eigen::Index>(i);
    return {z_[row], problem_.shape.map.row(row).transpose()};
  }
  [[nodiscard]] LogLinear constant(double value) const {
    return {std::log(value), Eigen::VectorXd::Zero(problem_.shape.free)};
  }
  [[nodiscard]] std::optional<LogLinear> log_sigma() const;
  [[nodiscard]] double standard_uncertainty(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& covariance) const;
  [[nodiscard]] ParameterState state_of(const Eigen::VectorXd& gradient) const;
  [[nodiscard]] ParameterUncertainty uncertainty_of(const Eigen::VectorXd& gradient) const;
  [[nodiscard]] FittedParameter fitted(const std::string& name, const LogLinear& x, double origin, double lower,
                                       double upper) const;
  [[nodiscard]] FittedParameter basis_row(std::size_t i) const;
  [[nodiscard]] FittedParameter derived(const std::string& name, const LogLinear& x) const;
  void add_lengths(std::vector<FittedParameter>& rows) const;

  const Problem& problem_;
  const Uncertainties& u_;
  Eigen::VectorXd z_;
};

// Of g · z, by the covariance of z; NaN where a z that it reads has none.
double Rows::standard_uncertainty(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& covariance) const {
  if (covariance.size() == 0) return no_uncertainty;
  double variance = 0.0;
  for (int a = 0; a < problem_.shape.free; ++a) {
    if (gradient[a] == 0.0) continue;
    const ParameterUncertainty& pa = u_.shape[static_cast<std::size_t>(a)];
    if (!std::isfinite(pa.u)) return pa.u;
    for (int b = 0; b < problem_.shape.free; ++b) {
      const ParameterUncertainty& pb = u_.shape[static_cast<std::size_t>(b)];
      if (pb.index >= 0) variance += gradient[a] * gradient[b] * covariance(pa.index, pb.index);
    }
  }
  return std::sqrt(variance);
}

ParameterState Rows::state_of(const Eigen::VectorXd& gradient) const {
  ParameterState state = ParameterState::fixed;
  for (int a = 0; a < problem_.shape.free; ++a) {
    const bool known = state != ParameterState::undetermined;
    if (gradient[a] != 0.0 && known) state = u_.shape[static_cast<std::size_t>(a)].state;
  }
  return state;
}

// Of g · z. Intervals reach as far as those of the z that contributes most; only one of z itself can be on a bound.
ParameterUncertainty Rows::uncertainty_of(const Eigen::VectorXd& gradient) const {
  ParameterUncertainty out;
  out.state = state_of(gradient);
  out.u = standard_uncertainty(gradient, u_.covariance);
  out.u_classical = standard_uncertainty(gradient, u_.covariance_classical);
  double by_scale = 0.0;
  double most = 0.0;
  for (int a = 0; a < problem_.shape.free; ++a) {
    const ParameterUncertainty& parent = u_.shape[static_cast<std::size_t>(a)];
    if (gradient[a] == 0.0) continue;
    if (parent.index >= 0 && u_.by_scale.size() > 0) by_scale += gradient[a] * u_.by_scale[parent.index];
    if (std::fabs(gradient[a]) * parent.u > most) {
      most = std::fabs(gradient[a]) * parent.u;
      out.k = parent.k;
    }
    if (gradient[a] == 1.0) out.released = parent.released;
  }
  out.u_scale = std::fabs(by_scale) * problem_.scale_u;
  set_by_readings(out, standard_uncertainty(gradient, u_.covariance_readings), u_.reduced_chi_square);
  return out;
}

// From those of the logarithm.
void set_intervals(FittedParameter& p, const ParameterIntervals& of_log, double origin) {
  const auto exponential = [origin](const Interval& x) {
    return Interval{origin + std::exp(x.lower), origin + std::exp(x.upper)};
  };
  p.interval_68 = p.value && of_log.at_68 ? std::optional(exponential(*of_log.at_68)) : std::nullopt;
  p.interval_95 = p.value && of_log.at_95 ? std::optional(exponential(*of_log.at_95)) : std::nullopt;
}

// A parameter that is one of z, or fixed. Its logarithm is what is normally distributed.
FittedParameter Rows::fitted(const std::string& name, const LogLinear& x, double origin, double lower,
                             double upper) const {
  const ShapeMap& map = problem_.shape;
  double log_lower = -infinity;
  double log_upper = infinity;
  for (int a = 0; a < map.free; ++a) {
    if (x.gradient[a] == 0.0) continue;
    const auto i = static_cast<std::size_t>(a);
    lower = map.lower_value[i];
    upper = map.upper_value[i];
    log_lower = map.lower[i];
    log_upper = map.upper[i];
  }
  const double scale = std::exp(x.log_value);
  const ParameterUncertainty of_log = uncertainty_of(x.gradient);
  ParameterUncertainty u = of_log;
  for (double* part : {&u.u, &u.u_classical, &u.u_readings, &u.u_readings_scaled, &u.u_scale}) *part *= scale;
  FittedParameter p = parameter_row(name, "", origin + scale, lower, upper, u);
  if (p.fixed) leave_without_uncertainty(p);
  set_intervals(p, intervals_of(x.log_value, log_lower, log_upper, of_log), origin);
  return p;
}

FittedParameter Rows::basis_row(std::size_t i) const {
  const ShapeParameter& s = problem_.basis->shape_parameters()[i];
  FittedParameter p = fitted(s.name, shape_parameter(i), s.origin, s.lower, s.upper);
  p.unit = s.unit;
  return p;
}

// A parameter that follows from others: no bounds of its own.
FittedParameter Rows::derived(const std::string& name, const LogLinear& x) const {
  FittedParameter p = fitted(name, x, 0.0, 0.0, infinity);
  ParameterUncertainty unbounded = uncertainty_of(x.gradient);
  unbounded.released.reset();
  set_intervals(p, intervals_of(x.log_value, -infinity, infinity, unbounded), 0.0);
  p.value = p.value ? std::optional(std::exp(x.log_value)) : std::nullopt;
  p.lower = 0.0;
  p.upper = infinity;
  p.at_lower = p.at_upper = false;
  p.derived = true;
  p.unit = "um";
  return p;
}

// Fitted, given, or from a given tau.
std::optional<LogLinear> Rows::log_sigma() const {
  if (const auto sigma = problem_.shape_index("sigma_um")) return shape_parameter(*sigma);
  if (problem_.known_sigma_um) return constant(*problem_.known_sigma_um);
  if (problem_.known_tau_um) return constant(*problem_.known_tau_um) + shape_parameter(*problem_.shape_index("slope"));
  return std::nullopt;
}

FittedParameter undetermined_row(const std::string& name, const std::string& unit) {
  FittedParameter p = parameter_row(name, "", 0.0, 0.0, infinity, {ParameterState::undetermined, infinity, -1});
  p.unit = unit;
  return p;
}

// sigma and tau beside the slopes: known, or not determined.
void Rows::add_lengths(std::vector<FittedParameter>& rows) const {
  const auto slope = problem_.shape_index("slope");
  const auto slope_y = problem_.shape_index("slope_y");
  const bool slope_known = slope && rows.front().value;
  FittedParameter sigma = undetermined_row("sigma_um", "um");
  FittedParameter tau = undetermined_row("tau_um", "um");
  FittedParameter tau_y = undetermined_row("tau_y_um", "um");
  if (const std::optional<LogLinear> log = slope_known ? log_sigma() : std::nullopt) {
    const bool from_tau = problem_.known_tau_um && !problem_.known_sigma_um;
    sigma = from_tau ? derived("sigma_um", *log) : fitted("sigma_um", *log, 0.0, 0.0, infinity);
    sigma.unit = "um";
    tau = derived("tau_um", *log - shape_parameter(*slope));
    tau.derived = !problem_.known_tau_um;
    if (problem_.known_tau_um) tau.fixed = true;
    if (slope_y) tau_y = derived("tau_y_um", *log - shape_parameter(*slope_y));
    // What was given stands as it was given: rounding must not make the three contradict each other in the file.
    if (problem_.known_sigma_um) sigma.value = problem_.known_sigma_um;
    if (problem_.known_tau_um) tau.value = problem_.known_tau_um;
    if (!sigma.value) tau.value.reset();
  }
  std::vector<FittedParameter> lengths{sigma, tau};
  if (slope_y) lengths.push_back(tau_y);
  rows.insert(rows.begin() + (slope_y ? 2 : 1), lengths.begin(), lengths.end());
}

std::vector<FittedParameter> Rows::rows() const {
  std::vector<FittedParameter> rows;
  const bool surface = problem_.model == surface_model;
  if (surface && !problem_.shape_index("slope")) rows.push_back(undetermined_row("slope", ""));
  for (std::size_t i = 0; i < problem_.basis->shape_parameters().size(); ++i) {
    const bool length = problem_.basis->shape_parameters()[i].name == "sigma_um";  // beside the slopes, see below
    if (!surface || !length) rows.push_back(basis_row(i));
  }
  if (surface) add_lengths(rows);
  return rows;
}

}  // namespace

void leave_without_uncertainty(FittedParameter& p) {
  p.u = p.u_classical = p.u_unscaled = p.u_chi2_scaled = p.u_scale = p.coverage_factor = std::nullopt;
  p.interval_68 = p.interval_95 = std::nullopt;
}

FittedParameter parameter_row(const std::string& name, const std::string& channel, double value, double lower,
                              double upper, const ParameterUncertainty& u) {
  FittedParameter p;
  p.name = name;
  p.channel = channel;
  if (u.state != ParameterState::undetermined) p.value = value;
  if (p.value) {
    const auto stated = [](double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; };
    p.u = stated(u.u);
    if (p.u) p.u_classical = stated(u.u_classical);
    p.u_unscaled = stated(u.u_readings);
    p.u_chi2_scaled = stated(u.u_readings_scaled);
    if (p.u && u.u_scale > 0.0) p.u_scale = u.u_scale;
    const ParameterIntervals intervals = intervals_of(value, lower, upper, u);
    p.interval_68 = intervals.at_68;
    p.interval_95 = intervals.at_95;
    p.coverage_factor = intervals.coverage_factor;
  }
  p.lower = lower;
  p.upper = upper;
  p.fixed = u.state == ParameterState::fixed;
  p.at_lower = u.state == ParameterState::at_lower;
  p.at_upper = u.state == ParameterState::at_upper;
  // On a bound the value is the bound, not what rounding or the exponential of its logarithm makes of it.
  if (p.at_lower) p.value = lower;
  if (p.at_upper) p.value = upper;
  return p;
}

std::vector<FittedParameter> shape_rows(const Problem& problem, const FitPoint& point, const Uncertainties& u) {
  return Rows(problem, point, u).rows();
}

}  // namespace goniofit
