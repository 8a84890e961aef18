#include "synthetic/exact_tests.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace goniofit {
namespace {

// P(X <= k) and P(X >= k) of n trials of probability p.
double lower_tail(Proportion x, double p) {
  if (x.count >= x.of) return 1.0;
  return boost::math::ibetac(static_cast<double>(x.count) + 1.0, static_cast<double>(x.of - x.count), p);
}

double upper_tail(Proportion x, double p) {
  if (x.count == 0) return 1.0;
  return boost::math::ibeta(static_cast<double>(x.count), static_cast<double>(x.of - x.count) + 1.0, p);
}

}  // namespace

Interval exact_limits(Proportion observed, double confidence) {
  if (observed.of == 0) return {0.0, 1.0};
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(observed.of);
  const auto k = static_cast<double>(observed.count);
  const double tail = 0.5 * (1.0 - confidence);
  return {Binomial::find_lower_bound_on_p(n, k, tail), Binomial::find_upper_bound_on_p(n, k, tail)};
}

double p_within(Proportion observed, Interval allowed) {
  const double fraction = observed.fraction();
  if (observed.of == 0 || (fraction >= allowed.lower && fraction <= allowed.upper)) return 1.0;
  const double tail =
      fraction < allowed.lower ? lower_tail(observed, allowed.lower) : upper_tail(observed, allowed.upper);
  return std::min(1.0, 2.0 * tail);
}

double p_at_most(Proportion observed, double rate) { return observed.of == 0 ? 1.0 : upper_tail(observed, rate); }

double p_mean_within(double mean, double standard_error, std::size_t n, double limit) {
  const double beyond = std::fabs(mean) - limit;
  if (beyond <= 0.0) return 1.0;
  if (!(standard_error > 0.0) || !std::isfinite(beyond)) return 0.0;
  const boost::math::students_t_distribution<double> student(static_cast<double>(n) - 1.0);
  return std::min(1.0, 2.0 * boost::math::cdf(boost::math::complement(student, beyond / standard_error)));
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(p.size() - i) * p[order[i]]);
    adjusted[order[i]] = std::min(1.0, largest);
  }
  return adjusted;
}

}  // namespace goniofit
