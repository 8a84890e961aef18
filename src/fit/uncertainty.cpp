#include "fit/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fit/joint_jacobian.h"
#include "fit/linear_spread.h"
#include "fit/reading_noise.h"

namespace goniofit {

namespace {

// `column2`: what a unit step of the parameter changes, squared and summed. No more than `noise2` is no effect at all.
ParameterState state_at(double value, double lower, double upper, double column2, double noise2) {
  const auto near = [value](double bound) {
    return std::isfinite(bound) && std::fabs(value - bound) <= 1e-12 * (1.0 + std::fabs(bound));
  };
  if (lower >= upper) return ParameterState::fixed;
  if (column2 <= noise2) return ParameterState::undetermined;
  if (near(lower)) return ParameterState::at_lower;
  if (near(upper)) return ParameterState::at_upper;
  return ParameterState::free;
}

void find_states(const Problem& problem, const FitPoint& point, const LinearSums& sums, Uncertainties& out) {
  // A change of the shape by a factor e that alters the whole scan by less than the residual of one reading: nobody
  // could tell it from no change. Noise-free scans have no residual; what they hold is then known to 1e-8 of their
  // signal.
  const double noise2 = std::max(sums.loss, 1e-16 * problem.total) / static_cast<double>(problem.values_used());
  const auto add = [](std::vector<ParameterUncertainty>& to, ParameterState state) {
    to.push_back({.state = state, .u = no_uncertainty});
  };
  for (std::size_t z = 0; z < point.z.size(); ++z) {
    double column2 = 0.0;
    for (const Eigen::MatrixXd& all : sums.triangles) column2 += all.col(static_cast<Eigen::Index>(z)).squaredNorm();
    add(out.shape, state_at(point.z[z], problem.shape.lower[z], problem.shape.upper[z], column2, noise2));
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    std::vector<ParameterUncertainty>& row = out.coefficients.emplace_back();
    for (Eigen::Index j = 0; j < channel.lower.size(); ++j) {
      const double column2 = sums.triangles[c].col(problem.shape.free + j).squaredNorm();
      add(row, state_at(point.coefficients[c][j], channel.lower[j], channel.upper[j], column2, 0.0));
    }
    if (point.optics.empty()) continue;
    const double column2 = sums.triangles[c].col(problem.shape.free + channel.lower.size()).squaredNorm();
    add(out.optics, state_at(point.optics[c], channel.optics_lower, channel.optics_upper, column2, 0.0));
  }
}

bool is_free(const ParameterUncertainty& p) { return p.state == ParameterState::free; }
bool is_on_bound(const ParameterUncertainty& p) {
  return p.state == ParameterState::at_lower || p.state == ParameterState::at_upper;
}

// Numbers the parameters that `chosen` is true of: the shape first, then channel after channel.
template <class Chosen>
ParameterPlaces places_of(const Uncertainties& u, const Chosen& chosen) {
  ParameterPlaces places;
  const auto place = [&](const ParameterUncertainty& p) { return chosen(p) ? places.size++ : -1; };
  for (const ParameterUncertainty& p : u.shape) places.shape.push_back(place(p));
  for (std::size_t c = 0; c < u.coefficients.size(); ++c) {
    std::vector<Eigen::Index>& row = places.coefficients.emplace_back();
    for (const ParameterUncertainty& p : u.coefficients[c]) row.push_back(place(p));
    if (!u.optics.empty()) places.optics.push_back(place(u.optics[c]));
  }
  return places;
}

template <class F>
void for_each_place(Uncertainties& u, const ParameterPlaces& places, const F& f) {
  const auto visit = [&f](std::vector<ParameterUncertainty>& row, const std::vector<Eigen::Index>& at) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (at[i] >= 0) f(row[i], at[i]);
    }
  };
  visit(u.shape, places.shape);
  for (std::size_t c = 0; c < u.coefficients.size(); ++c) visit(u.coefficients[c], places.coefficients[c]);
  visit(u.optics, places.optics);
}

// The scale is known as normally distributed: it takes its part of the square out of what is open in `k` (Welch).
CoverageFactors with_scale(const CoverageFactors& k, double u, double u_scale) {
  if (u_scale == 0.0) return k;
  const double part = u * u / (u * u + u_scale * u_scale);
  const CoverageFactors normal;
  const auto mixed = [part](double own, double other) {
    return std::sqrt(part * own * own + (1.0 - part) * other * other);
  };
  return {mixed(k.at_68, normal.at_68), mixed(k.at_95, normal.at_95)};
}

struct Stated {
  double u;
  CoverageFactors k;
};
Stated stated(const Spread& spread, Eigen::Index i, double u_scale) {
  const double u = std::sqrt(spread.covariance(i, i));
  return {std::hypot(u, u_scale), with_scale(spread.k[static_cast<std::size_t>(i)], u, u_scale)};
}

// Of readings that have a say in the loss.
double reduced_chi_square(const LinearParts& parts, Eigen::Index parameters) {
  double sum = 0.0;
  Eigen::Index count = 0;
  parts.for_each([&](const Problem& part, const Linearisation& l) {
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      const Eigen::VectorXd sd = reading_sd(part, l, c);
      for (Eigen::Index i = 0; i < sd.size(); ++i) {
        if (!(sd[i] > 0.0)) continue;
        sum += l.residuals[c][i] * l.residuals[c][i] / (sd[i] * sd[i]);
        ++count;
      }
    }
  });
  return count > parameters ? sum / static_cast<double>(count - parameters) : no_uncertainty;
}

// What the readings' own uncertainties give, whatever is stated.
void add_readings(const Linear& linear, Uncertainties& out) {
  if (!states_uncertainties(linear.parts.problem())) return;
  out.covariance_readings = spread_by_stated_u(linear).covariance;
  out.reduced_chi_square = reduced_chi_square(linear.parts, linear.j.size());
}

void add_stated(const Linear& linear, const ParameterPlaces& places, Uncertainties& out) {
  const Problem& problem = linear.parts.problem();
  const bool by_readings = problem.uncertainty == UncertaintySource::readings;
  const auto size = static_cast<std::size_t>(places.size);
  std::vector<Eigen::Index> all(size);
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  const Spread spread =
      by_readings ? Spread{out.covariance_readings, std::vector<CoverageFactors>(size), std::vector<bool>(size, false)}
                  : stated_spread(linear, all, out.source);
  out.by_scale = change_by_scale(linear);
  out.covariance = spread.covariance + problem.scale_u * problem.scale_u * out.by_scale * out.by_scale.transpose();
  for_each_place(out, places, [&](ParameterUncertainty& p, Eigen::Index i) {
    p.u_scale = std::fabs(out.by_scale[i]) * problem.scale_u;
    if (out.covariance_readings.size() > 0)
      set_by_readings(p, std::sqrt(out.covariance_readings(i, i)), out.reduced_chi_square);
    if (spread.single[static_cast<std::size_t>(i)]) return;
    const Stated s = stated(spread, i, p.u_scale);
    p.u = s.u;
    p.k = s.k;
  });
}

bool points_outward(const ParameterUncertainty& p) {
  return p.state == ParameterState::at_lower ? p.released->step <= 0.0 : p.released->step >= 0.0;
}

// Everything on a bound, released. Where these cannot all be told from each other, or some would turn into the interval
// once others have left theirs, each by itself.
void release(const LinearParts& parts, const LinearSums& sums, const ParameterPlaces& places, Uncertainties& out) {
  const Problem& problem = parts.problem();
  const JointJacobian j(sums, places);
  const bool spare = problem.values_used() > static_cast<std::size_t>(j.size());
  if (j.singular() || (!spare && problem.uncertainty != UncertaintySource::readings)) return;
  const Linear linear{parts, j, -j.solve(j.gradient(sums))};
  std::vector<Eigen::Index> held;
  for_each_place(out, places, [&held](const ParameterUncertainty& p, Eigen::Index i) {
    if (is_on_bound(p)) held.push_back(i);
  });
  UncertaintySource source = out.source;
  const Spread spread = stated_spread(linear, held, source);
  const Eigen::VectorXd by_scale = change_by_scale(linear);
  for_each_place(out, places, [&](ParameterUncertainty& p, Eigen::Index i) {
    if (!is_on_bound(p) || spread.single[static_cast<std::size_t>(i)]) return;
    const Stated s = stated(spread, i, std::fabs(by_scale[i]) * problem.scale_u);
    p.released = Released{linear.step[i], s.u, s.k};
  });
}

void release_bounds(const LinearParts& parts, const LinearSums& sums, Uncertainties& out) {
  const ParameterPlaces all = places_of(out, [](const auto& p) { return is_free(p) || is_on_bound(p); });
  std::vector<ParameterUncertainty*> held;
  for_each_place(out, all, [&held](ParameterUncertainty& p, Eigen::Index) {
    if (is_on_bound(p)) held.push_back(&p);
  });
  if (held.empty()) return;
  release(parts, sums, all, out);
  for (const ParameterUncertainty* one : held) {
    if (one->released && points_outward(*one)) continue;
    release(parts, sums, places_of(out, [one](const auto& p) { return is_free(p) || &p == one; }), out);
  }
}

}  // namespace

std::string_view name_of(UncertaintySource source) noexcept {
  switch (source) {
    case UncertaintySource::readings:
      return "readings";
    case UncertaintySource::hc3:
      return "hc3";
    case UncertaintySource::angles:
      return "incidence angles";
    case UncertaintySource::residuals:
      break;
  }
  return "residuals";
}

bool parse_uncertainty(std::string_view word, std::optional<UncertaintySource>& to) noexcept {
  if (word == "auto") {
    to.reset();
  } else if (word == "readings") {
    to = UncertaintySource::readings;
  } else if (word == "residuals") {
    to = UncertaintySource::residuals;
  } else if (word == "hc3") {
    to = UncertaintySource::hc3;
  } else if (word == "angles") {
    to = UncertaintySource::angles;
  } else {
    return false;
  }
  return true;
}

void set_by_readings(ParameterUncertainty& p, double u, double reduced_chi_square) {
  p.u_readings = std::hypot(u, p.u_scale);
  p.u_readings_scaled = std::hypot(u * std::sqrt(reduced_chi_square), p.u_scale);
}

Uncertainties uncertainties(const Problem& problem, const FitPoint& point, const Linearisation& l) {
  const LinearParts parts(problem, point, l);
  return uncertainties(parts, linear_sums(parts, nullptr));
}

Uncertainties uncertainties(const LinearParts& parts, const LinearSums& sums) {
  const Problem& problem = parts.problem();
  Uncertainties out;
  out.source = problem.uncertainty;
  find_states(problem, parts.point(), sums, out);
  const ParameterPlaces places = places_of(out, is_free);
  if (places.size == 0) {
    release_bounds(parts, sums, out);
    return out;
  }
  const JointJacobian j(sums, places);
  if (j.singular()) {
    const std::vector<bool> null = j.in_null_space();
    for_each_place(out, places, [&null](ParameterUncertainty& p, Eigen::Index i) {
      if (null[static_cast<std::size_t>(i)]) p.state = ParameterState::undetermined;
    });
    return out;
  }
  out.covariance_unscaled = j.root() * j.root().transpose();
  for_each_place(out, places, [&out](ParameterUncertainty& p, Eigen::Index i) {
    p.index = i;
    p.u_unscaled = std::sqrt(out.covariance_unscaled(i, i));
  });
  const Linear linear{parts, j};
  add_readings(linear, out);
  const auto residuals = static_cast<Eigen::Index>(problem.values_used());
  const bool spare = residuals > places.size;
  if (spare) {
    out.residual_variance = sums.loss / static_cast<double>(residuals - places.size);
    out.covariance_classical = out.residual_variance * out.covariance_unscaled;
    for_each_place(out, places, [&out](ParameterUncertainty& p, Eigen::Index i) {
      p.u_classical = std::sqrt(out.covariance_classical(i, i));
    });
  } else if (problem.uncertainty != UncertaintySource::readings) {
    return out;
  }
  add_stated(linear, places, out);
  release_bounds(parts, sums, out);
  return out;
}

}  // namespace goniofit
