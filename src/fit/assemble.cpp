#include "fit/assemble.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "fit/model.h"
#include "fit/parameter_settings.h"
#include "fit/uncertainty.h"

namespace goniofit {

namespace {

std::string percent(double part) {
  std::ostringstream text;
  text << std::setprecision(2) << 100.0 * part << " %";
  return text.str();
}

using ByName = std::map<std::string, std::vector<std::string>>;  // parameter, its channels

// "k_dd of every channel, k_uds of R and B".
std::string listed(const ByName& parameters, std::size_t all) {
  std::string text;
  for (const auto& [name, channels] : parameters) {
    text += (text.empty() ? "" : ", ") + name + " of ";
    if (channels.size() == all && all > 1) {
      text += "every channel";
      continue;
    }
    for (std::size_t i = 0; i < channels.size(); ++i) {
      text += (i == 0 ? "" : i + 1 == channels.size() ? " and " : ", ") + channels[i];
    }
  }
  return text;
}

FittedParameter undetermined_length(const char* name) {
  FittedParameter p;
  p.name = name;
  p.unit = "um";
  p.upper = std::numeric_limits<double>::infinity();
  return p;
}

class Assembly {
 public:
  Assembly(const Problem& problem, const Scan& scan, const Polished& best)
      : problem_(problem),
        scan_(scan),
        best_(best),
        l_(linearise(problem, best.point)),
        u_(uncertainties(problem, best.point, l_)) {}
  [[nodiscard]] FitResult result();

 private:
  void add_totals();
  void add_shape();
  void add_channel(std::size_t c);
  void add_coefficient(std::size_t c, std::size_t column);
  void add_warnings();
  void warn_of_surface();
  void record(const FittedParameter& p, bool identifiable);
  [[nodiscard]] FittedParameter row(const std::string& name, const std::string& channel, double value, double lower,
                                    double upper, const ParameterUncertainty& u) const;

  const Problem& problem_;
  const Scan& scan_;
  const Polished& best_;
  Linearisation l_;
  Uncertainties u_;
  FitResult out_;
  FitSummary summary_;
};

FitResult Assembly::result() {
  Material& m = out_.material;
  m.name = scan_.name;
  m.components = problem_.components;
  m.terms = problem_.terms;
  m.fs_form = problem_.fs_form;
  m.solid_angle_sr = problem_.solid_angle_sr;
  out_.notes = problem_.notes;
  out_.warnings = problem_.warnings;
  out_.components_were_auto = problem_.components_were_auto;
  add_totals();
  add_shape();
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) add_channel(c);
  add_warnings();
  m.fit = summary_;
  return std::move(out_);
}

void Assembly::add_totals() {
  out_.weight = problem_.weighting;
  out_.samples = problem_.samples();
  out_.left_out_90 = problem_.exclusions.at_90;
  out_.left_out_max_theta = problem_.exclusions.beyond_max_theta;
  out_.negative_values = problem_.exclusions.negative_values;
  out_.loss = l_.loss;
  const auto n = static_cast<double>(problem_.samples());
  out_.rms = std::sqrt(l_.loss / (n * static_cast<double>(problem_.channels.size())));
  for (const Eigen::VectorXd& r : l_.residuals)
    out_.channel_rms.push_back(std::sqrt(r.cwiseQuotient(problem_.weight).squaredNorm() / n));
  out_.converged = best_.converged;
  summary_.loss = out_.loss;
  summary_.rms = out_.rms;
  summary_.samples = out_.samples;
  summary_.converged = out_.converged;
}

FittedParameter Assembly::row(const std::string& name, const std::string& channel, double value, double lower,
                              double upper, const ParameterUncertainty& u) const {
  FittedParameter p;
  p.name = name;
  p.channel = channel;
  if (u.state != ParameterState::undetermined) p.value = value;
  if (std::isfinite(u.u)) p.u = u.u;
  p.lower = lower;
  p.upper = upper;
  p.fixed = u.state == ParameterState::fixed;
  p.at_lower = u.state == ParameterState::at_lower;
  p.at_upper = u.state == ParameterState::at_upper;
  return p;
}

void Assembly::record(const FittedParameter& p, bool identifiable) {
  out_.parameters.push_back(p);
  const std::string key = p.channel.empty() ? p.name : p.channel + "." + p.name;
  summary_.identifiable[key] = identifiable;
  if (!p.u) return;
  if (p.channel.empty()) {
    summary_.shared_uncertainty[p.name] = *p.u;
  } else {
    summary_.channel_uncertainty[p.channel][p.name] = *p.u;
  }
}

// Slope, sigma and tau from the logarithms z by the map of the problem; uncertainties to first order.
void Assembly::add_shape() {
  const ShapeMap& map = problem_.shape;
  const Eigen::Vector2d log_shape = map.log_shape(best_.point.z.data());
  // Variance of g · z; NaN where a z that it reads has none.
  const auto log_u = [&](const Eigen::Vector2d& gradient) {
    double variance = 0.0;
    for (int a = 0; a < map.free; ++a) {
      const ParameterUncertainty& pa = u_.shape[static_cast<std::size_t>(a)];
      if (gradient[a] == 0.0) continue;
      if (!std::isfinite(pa.u)) return std::numeric_limits<double>::quiet_NaN();
      for (int b = 0; b < map.free; ++b) {
        const ParameterUncertainty& pb = u_.shape[static_cast<std::size_t>(b)];
        if (gradient[b] != 0.0 && pb.index >= 0)
          variance += gradient[a] * gradient[b] * u_.covariance(pa.index, pb.index);
      }
    }
    return std::sqrt(variance);
  };
  const auto state_of = [&](const Eigen::Vector2d& gradient) {
    ParameterState state = ParameterState::fixed;
    for (int a = 0; a < map.free; ++a) {
      if (gradient[a] != 0.0 && state != ParameterState::undetermined)
        state = u_.shape[static_cast<std::size_t>(a)].state;
    }
    return state;
  };
  const auto shape_row = [&](const std::string& name, double log_value, const Eigen::Vector2d& gradient, double lower,
                             double upper) {
    const double value = std::exp(log_value);
    FittedParameter p = row(name, "", value, lower, upper, {state_of(gradient), value * log_u(gradient), -1});
    if (p.fixed) p.u.reset();
    // On a bound the value is the bound, not the exponential of its logarithm.
    if (p.at_lower) p.value = lower;
    if (p.at_upper) p.value = upper;
    if (name != "slope") p.unit = "um";
    return p;
  };
  const Eigen::Vector2d slope_gradient = map.map.row(0).transpose();
  const auto bounds = [&](int z, double lower, double upper) {
    if (z >= map.free) return std::pair(lower, upper);
    return std::pair(map.lower_value[static_cast<std::size_t>(z)], map.upper_value[static_cast<std::size_t>(z)]);
  };
  const auto [slope_low, slope_high] = bounds(map.outer_moves_slope ? 0 : map.free, slope_min, slope_max);
  const FittedParameter slope = shape_row("slope", log_shape[0], slope_gradient, slope_low, slope_high);
  record(slope, slope.value.has_value());
  out_.material.surface.slope = slope.value;

  // sigma: fitted through coh, given, or from a given tau. tau from the two.
  const bool through_coh = problem_.basis->shape_parameters().size() > 1;
  const double infinity = std::numeric_limits<double>::infinity();
  std::optional<double> log_sigma;
  Eigen::Vector2d sigma_gradient = Eigen::Vector2d::Zero();
  if (through_coh) {
    log_sigma = log_shape[1];
    sigma_gradient = map.map.row(1).transpose();
  } else if (problem_.known_sigma_um) {
    log_sigma = std::log(*problem_.known_sigma_um);
  } else if (problem_.known_tau_um) {
    log_sigma = std::log(*problem_.known_tau_um) + log_shape[0];
    sigma_gradient = slope_gradient;
  }
  FittedParameter sigma = undetermined_length("sigma_um");
  FittedParameter tau = undetermined_length("tau_um");
  if (log_sigma && slope.value) {
    const auto [low, high] = bounds(
        through_coh && map.free > 0 && map.map(1, map.free - 1) == 1.0 && map.map(0, map.free - 1) == 0.0 ? map.free - 1
                                                                                                          : 2,
        0.0, infinity);
    sigma = shape_row("sigma_um", *log_sigma, sigma_gradient, low, high);
    tau = shape_row("tau_um", *log_sigma - log_shape[0], sigma_gradient - slope_gradient, 0.0, infinity);
    // Rounding must not make the three contradict each other in the file.
    if (problem_.known_sigma_um) sigma.value = problem_.known_sigma_um;
    if (problem_.known_tau_um) tau.value = problem_.known_tau_um;
    tau.derived = !problem_.known_tau_um;
    sigma.derived = !through_coh && !problem_.known_sigma_um;
    if (tau.derived || sigma.derived) tau.at_lower = tau.at_upper = false;
    if (!sigma.value) tau.value.reset();
  }
  record(sigma, sigma.value.has_value());
  record(tau, tau.value.has_value());
  out_.material.surface.sigma_um = sigma.value;
  out_.material.surface.tau_um = tau.value;
}

void Assembly::add_channel(std::size_t c) {
  const ProblemChannel& from = problem_.channels[c];
  MaterialChannel& to = out_.material.channels.emplace_back();
  to.name = from.name;
  to.wavelength_um = from.wavelength_um;
  if (problem_.free_optics == FreeOptics::f0) {
    to.f0 = best_.point.optics[c];
  } else if (from.n) {
    to.n = problem_.free_optics == FreeOptics::n ? best_.point.optics[c] : *from.n;
    to.kappa = from.kappa;
  } else {
    to.f0 = from.optics.f0;
  }
  if (problem_.free_optics != FreeOptics::none) {
    const std::string name = problem_.free_optics == FreeOptics::n ? "n" : "f0";
    const FittedParameter p =
        row(name, from.name, best_.point.optics[c], from.optics_lower, from.optics_upper, u_.optics[c]);
    // An optical parameter that no coefficient makes visible stays where the search left it: it has no effect there.
    record(p, p.value.has_value());
  }
  for (std::size_t j = 0; j < problem_.basis->columns().size(); ++j) add_coefficient(c, j);
}

void Assembly::add_coefficient(std::size_t c, std::size_t column) {
  const auto j = static_cast<Eigen::Index>(column);
  const ProblemChannel& channel = problem_.channels[c];
  const Coefficient coefficient = problem_.basis->columns()[column].coefficient;
  FittedParameter p = row(std::string(name_of(coefficient)), channel.name, best_.point.coefficients[c][j],
                          channel.lower[j], channel.upper[j], u_.coefficients[c][column]);
  // A lobe whose width nobody can tell is no lobe whose strength anybody can.
  if (problem_.basis->columns()[column].reads_shape && !out_.material.surface.slope && p.value != 0.0) {
    p.value.reset();
    p.u.reset();
  }
  // An uncertainty beyond both the value and 1 says nothing of a coefficient whose scale is 1. Where all that it adds
  // to the scan is less than the residual of one reading, it is not determined; else it is so only apart from its
  // companions.
  const bool says_nothing = p.value && p.u && *p.u > std::max(1.0, *p.value);
  const double noise2 = out_.loss / static_cast<double>(out_.samples * problem_.channels.size());
  if (says_nothing && *p.value * *p.value * l_.by_coefficient[c].col(j).squaredNorm() < noise2) {
    p.value.reset();
    p.u.reset();
  } else if (says_nothing) {
    out_.warnings.push_back(p.name + " of " + p.channel +
                            " is not determined apart from the others: its uncertainty exceeds its value; fix it or "
                            "another parameter of its component");
  }
  record(p, p.value.has_value() && !says_nothing);
  out_.material.channels[c].coefficient(coefficient) = p.value;
}

void Assembly::warn_of_surface() {
  const Surface& s = out_.material.surface;
  const bool has_coh = problem_.components.has(Effect::coh);
  if (!s.slope) {
    out_.warnings.emplace_back(
        "slope is not determined: no directional part (dd, fs) is left in the fit; leave these out of the components, "
        "or measure near the mirror direction");
    if (has_coh) out_.material.components.erase(Effect::coh);
    return;
  }
  if (has_coh && !s.sigma_um) {
    out_.material.components.erase(Effect::coh);
    out_.warnings.emplace_back(
        "coh vanishes in this scan, so sigma_um is not determined: the surface is too rough for its wavelengths to "
        "reflect coherently; fit it without coh");
  } else if (!s.sigma_um) {
    out_.notes.emplace_back(
        "sigma and tau enter only as slope = sigma/tau, so neither is determined alone; give a measured one (--fix "
        "sigma_um=...), or include coh");
  }
  const FittedParameter& slope = out_.parameters.front();
  if (slope.at_lower || slope.at_upper) {
    out_.warnings.push_back(
        std::string("slope ended on its ") + (slope.at_lower ? "lower" : "upper") +
        " bound: the scan does not resolve the lobe, or the model does not describe it; look at the plot");
  } else if (slope.value && slope.u && *slope.u > 0.5 * *slope.value) {
    out_.warnings.emplace_back(
        "slope is weakly determined (u above half its value): the directional part is small or was hardly sampled; "
        "measure nearer to the mirror direction, or leave dd out");
  }
}

void Assembly::add_warnings() {
  if (!out_.converged)
    out_.warnings.emplace_back(
        "the fit did not converge; look at the plot and at the bounds, and try fewer components");
  warn_of_surface();
  ByName on_lower;
  ByName on_upper;
  for (const FittedParameter& p : out_.parameters) {
    if (p.channel.empty() || p.fixed) continue;
    if (p.at_lower) on_lower[p.name].push_back(p.channel);
    if (p.at_upper) on_upper[p.name].push_back(p.channel);
    if (!p.value) {
      out_.warnings.push_back(
          p.channel + "." + p.name +
          " is not determined: no reading of the scan depends on it alone; leave its component out, "
          "or fix it");
    }
  }
  const std::size_t channels = problem_.channels.size();
  if (!on_lower.empty()) {
    out_.notes.push_back("on the lower bound: " + listed(on_lower, channels) +
                         "; the uncertainties of the others hold with these where they are");
  }
  if (!on_upper.empty()) {
    out_.warnings.push_back("on the upper bound: " + listed(on_upper, channels) +
                            "; check the scan's absolute scale and the refractive index, or widen the bound (--bound "
                            "NAME=MIN:MAX)");
  }
  const double unexplained = std::sqrt(l_.loss / std::max(problem_.total, std::numeric_limits<double>::min()));
  if (unexplained > 0.3) {
    out_.warnings.push_back(
        "the model leaves " + percent(unexplained) +
        " of the weighted signal unexplained (root mean square); look at the plot before using the parameters");
  }
  if (out_.negative_values > 0) {
    out_.notes.push_back(std::to_string(out_.negative_values) +
                         " negative readings were kept: noise around zero, which must not be cut off");
  }
  if (problem_.components.has(Effect::fs) && problem_.weighting == Weight::cosine) {
    const bool weak = std::any_of(out_.parameters.begin(), out_.parameters.end(), [](const FittedParameter& p) {
      return p.name == "k_fs" && p.value && p.u && *p.u > 0.1 * *p.value;
    });
    if (weak)
      out_.notes.emplace_back(
          "k_fs is weak under the cosine-weighted loss, which gives grazing incidence little say; the loss is the "
          "limit, not the data");
  }
}

}  // namespace

FitResult assemble(const Problem& problem, const Scan& scan, const Polished& best) {
  return Assembly(problem, scan, best).result();
}

}  // namespace goniofit
