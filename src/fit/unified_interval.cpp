#include "fit/unified_interval.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace goniofit {

namespace {

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }
double normal_cdf(double x) { return 0.5 * std::erfc(-x * 0.7071067811865476); }

template <class F>
double root_between(const F& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low >= 0.0) return low;
  if (at_high <= 0.0) return high;
  std::uintmax_t iterations = 60;
  const auto [a, b] = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                        boost::math::tools::eps_tolerance<double>(30), iterations);
  return 0.5 * (a + b);
}

// Means not below 0, standard deviation 1. What a mean accepts is [start, mean + d].
class HalfLine {
 public:
  explicit HalfLine(double probability)
      : probability_(probability),
        one_sided_(normal_quantile(probability)),
        central_(normal_quantile(0.5 + 0.5 * probability)) {}

  /// Means that accept x.
  [[nodiscard]] Interval means(double x) const {
    if (x >= 2.0 * central_ + 1e-9) return {x - central_, x + central_};
    Interval out;
    out.lower = x <= one_sided_ ? 0.0 : root_between([&](double m) { return m + reach(m) - x; }, 0.0, x);
    const double highest = std::max(x, 0.0) + central_;
    out.upper = root_between([&](double m) { return start(m) - x; }, 1e-12, highest);
    return out;
  }

 private:
  /// d of a mean. Below 0 the best mean is 0, so both ends have the same ratio, exp(-d²/2), where the lower one is at
  /// -(mean² + d²) / (2 mean) from the mean.
  [[nodiscard]] double reach(double mean) const {
    if (mean >= central_) return central_;
    if (mean <= 0.0) return one_sided_;
    const auto excess = [&](double d) {
      return normal_cdf(d) - normal_cdf(-(mean * mean + d * d) / (2.0 * mean)) - probability_;
    };
    return root_between(excess, one_sided_ - 1e-9, central_);
  }
  [[nodiscard]] double start(double mean) const {
    if (mean >= central_) return mean - central_;
    const double d = reach(mean);
    return (mean * mean - d * d) / (2.0 * mean);
  }

  double probability_, one_sided_, central_;
};

}  // namespace

double coverage_factor(double probability, double freedom) {
  const double p = 0.5 + 0.5 * probability;
  if (!(freedom < 1e6)) return normal_quantile(p);
  return boost::math::quantile(boost::math::students_t(std::max(freedom, 1.0)), p);
}

Interval unified_interval(double estimate, double u, double lower, double upper, double probability) {
  const HalfLine half(probability);
  const bool from_below = estimate - lower <= upper - estimate;
  Interval out{estimate, estimate};
  if (from_below && std::isfinite(lower)) {
    const Interval m = half.means((estimate - lower) / u);
    out = {lower + u * m.lower, lower + u * m.upper};
  } else if (!from_below && std::isfinite(upper)) {
    const Interval m = half.means((upper - estimate) / u);
    out = {upper - u * m.upper, upper - u * m.lower};
  } else {
    const double half_width = u * normal_quantile(0.5 + 0.5 * probability);
    out = {estimate - half_width, estimate + half_width};
  }
  return {std::clamp(out.lower, lower, upper), std::clamp(out.upper, lower, upper)};
}

}  // namespace goniofit
