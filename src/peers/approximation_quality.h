#pragma once
// The two figures by which Schlick 1994 judges an approximation: epsilon, its mean error, and gamma, how many times
// faster it is.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

namespace goniofit {

struct ApproximationError {
  double mean_absolute = 0.0;  ///< his epsilon
  double mean_relative = 0.0;  ///< what readers take it for
  double rms_relative = 0.0;
  double max_absolute = 0.0;
  double max_relative = 0.0;
  double l1 = 0.0;  ///< mean absolute error over mean absolute value
};

/// Takes pairs of values one after the other, all of the same weight.
class ApproximationTally {
 public:
  void add(double truth, double approximation) noexcept {
    const double absolute = std::fabs(approximation - truth);
    const double relative = absolute / std::fabs(truth);
    ++count_;
    sums_.mean_absolute += absolute;
    sums_.mean_relative += relative;
    sums_.rms_relative += relative * relative;
    sums_.max_absolute = std::max(sums_.max_absolute, absolute);
    sums_.max_relative = std::max(sums_.max_relative, relative);
    sums_.l1 += std::fabs(truth);
  }
  /// Of at least one pair.
  [[nodiscard]] ApproximationError result() const noexcept {
    ApproximationError e = sums_;
    const auto n = static_cast<double>(count_);
    e.mean_absolute /= n;
    e.mean_relative /= n;
    e.rms_relative = std::sqrt(e.rms_relative / n);
    e.l1 = sums_.mean_absolute / sums_.l1;
    return e;
  }

 private:
  ApproximationError sums_;
  std::size_t count_ = 0;
};

/// Over uniform x in (lower, upper), by the midpoint rule: the ends, where functions vanish, are not touched.
template <class Exact, class Approximation>
[[nodiscard]] ApproximationError approximation_error(const Exact& exact, const Approximation& approximation,
                                                     double lower, double upper, std::size_t samples = 10000) {
  ApproximationTally tally;
  const double n = static_cast<double>(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double x = lower + (upper - lower) * (static_cast<double>(i) + 0.5) / n;
    tally.add(exact(x), approximation(x));
  }
  return tally.result();
}

/// gamma: time of `exact` over time of `approximation`, each the least of `repetitions` passes over the interval
/// (least, because whatever else the machine does only adds to it).
template <class Exact, class Approximation>
[[nodiscard]] double speed_gain(const Exact& exact, const Approximation& approximation, double lower, double upper,
                                std::size_t samples = 20000, int repetitions = 7) {
  const auto least_time = [&](const auto& f) {
    double least = HUGE_VAL;
    volatile double sink = 0.0;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      const auto start = std::chrono::steady_clock::now();
      double sum = 0.0;
      for (std::size_t i = 0; i < samples; ++i)
        sum += f(lower + (upper - lower) * (static_cast<double>(i) + 0.5) / static_cast<double>(samples));
      sink = sum;
      least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    static_cast<void>(sink);
    return least;
  };
  return least_time(exact) / least_time(approximation);
}

}  // namespace goniofit
