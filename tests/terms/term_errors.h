#pragma once
// What the tests of the terms share: where they measure, and how they count errors against 50 digits.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "geometry/pair.h"
#include "terms/zenith.h"

namespace goniofit::term_errors {

using Big = boost::multiprecision::cpp_bin_float_50;

/// One direction, as doubles that count as exact.
struct Zenith {
  double c, one_minus_c;
  bool hard;  ///< a corner in which naive forms fail
  [[nodiscard]] double s() const { return sine(c, one_minus_c); }
};

[[nodiscard]] inline Zenith at_angle(double theta, bool hard) {
  const double half = std::sin(0.5 * theta);
  return {std::cos(theta), 2.0 * half * half, hard};
}

/// One cosine out of each of `strata` equal intervals, at a place of its own, and the corners.
[[nodiscard]] inline std::vector<Zenith> zeniths(int strata) {
  std::vector<Zenith> out;
  double place = 0.5;
  for (int i = 0; i < strata; ++i) {
    place = std::fmod(place + 0.6180339887498949, 1.0);
    const double c = (i + place) / strata;
    out.push_back({c, 1.0 - c, false});
  }
  for (const double theta : {1e-300, 1e-30, 1e-9, 1e-6, 1e-3}) out.push_back(at_angle(theta, true));
  for (const double c : {1.7453292519943295e-8 /* 89.999999° */, 1e-12, 1e-30, 1e-100, 1e-200, 1e-300})
    out.push_back({c, 1.0 - c, true});
  out.push_back({1.0, 0.0, true});
  return out;
}

inline const std::vector<double> slopes{1e-6, 1e-3, 0.02, 0.1, 0.17, 0.5, 1.0, 3.0, 10.0};

/// Only what the terms of one direction read.
[[nodiscard]] inline Pair pair_of(const Zenith& i, const Zenith& r) {
  Pair p{};
  p.cos_i = i.c;
  p.cos_r = r.c;
  p.one_minus_cos_i = i.one_minus_c;
  p.one_minus_cos_r = r.one_minus_c;
  return p;
}

[[nodiscard]] inline double relative_error(double got, const Big& truth) {
  if (truth == 0) return got == 0.0 ? 0.0 : HUGE_VAL;
  const double error = std::fabs(static_cast<double>((got - truth) / truth));
  return std::isnan(error) ? HUGE_VAL : error;
}

/// Largest and RMS error of a run, and the naive form's error at the place of the largest naive error.
class Errors {
 public:
  void add(double error, const std::string& where) {
    ++count_;
    sum_ += error * error;
    if (error >= worst_) worst_ = error, where_ = where;
  }
  void add_naive(double error, const std::string& where) {
    if (!(error <= naive_)) naive_ = error, naive_where_ = where;
  }
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] double naive() const { return naive_; }
  void print(const char* name) const {
    std::printf("  %-44s %5d places, max %.2g, RMS %.2g, worst at %s\n", name, count_, worst_,
                std::sqrt(sum_ / std::max(1, count_)), where_.c_str());
    if (!naive_where_.empty()) std::printf("  %-44s naive form: %.2g at %s\n", "", naive_, naive_where_.c_str());
  }

 private:
  int count_ = 0;
  double sum_ = 0.0;
  double worst_ = 0.0;
  double naive_ = -1.0;
  std::string where_, naive_where_;
};

template <class... Numbers>
[[nodiscard]] std::string place(const char* format, Numbers... numbers) {
  char text[160];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

/// d f/d x by a central difference at 50 digits: truncation near 1e-14, round-off 1e-40 of f.
template <class F>
[[nodiscard]] Big derivative(const F& f, double x) {
  const Big h = Big(x) * Big("1e-10");
  return (f(Big(x) + h) - f(Big(x) - h)) / (2 * h);
}

}  // namespace goniofit::term_errors
