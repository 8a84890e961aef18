#pragma once
// Which width of a lobe samples an effect best at one incidence, by trying. Private to the sampler.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "../geometry/angles.h"
#include "sampling_lobes.h"

namespace goniofit::lobe_width {

/// Part of the dd and fs samples that is drawn by the cosine instead. It bounds the weights where a lobe is too low (by
/// 20 pi f over the share of effects other than coh), at the price of as much relative variance where it is right.
/// Measured on the paper's samples, 0.02 and 0.1 are no better overall.
inline constexpr double defensive_share = 0.05;

/// Density of a lobe with its defensive part.
template <class Lobe>
[[nodiscard]] double defended_density(const Lobe& lobe, const Direction& l, const Direction& v) noexcept {
  return defensive_share * CosineLobe::density(v) + (1.0 - defensive_share) * lobe.density(l, v);
}

/// Points of the unit cube of low discrepancy: multiples of the powers of 1/g, g⁴ = g + 1 (Roberts 2018).
[[nodiscard]] inline std::array<double, 3> cube_point(std::size_t i) noexcept {
  constexpr double g = 1.22074408460575947536;
  const auto n = static_cast<double>(i);
  const auto fraction = [](double x) { return x - std::floor(x); };
  return {fraction(0.5 + n / g), fraction(0.5 + n / (g * g)), fraction(0.5 + n / (g * g * g))};
}

/// A light at this height, its azimuth by u: anisotropic surfaces are averaged over it.
[[nodiscard]] inline Direction light_at(double cos_i, double u) noexcept {
  const double sin_i = std::sqrt(1.0 - cos_i * cos_i);
  return {sin_i * std::cos(2.0 * pi * u), sin_i * std::sin(2.0 * pi * u), cos_i};
}

struct Fit {
  double log_width;      ///< ln of the factor on the lobe's nominal width
  double albedo;         ///< integral of the integrand
  double second_moment;  ///< of the weights; albedo² at best
};

/// Why by trying: relative variances of the weights of dd at lit angles of 0, 85 and 88° are, for LT's laser paper,
///   width 2 sigma/tau 0.03, 0.63, 7.0;  2 sigma_e/tau of the mirror direction 0.03, 0.26, 520;  the geometric mean of
///   both 0.03, 0.27, 0.44,
/// but for a surface of slope 1 (aluminium) that mean leaves 3.7 at 0°, where the half of it leaves 0.8; wave optics
/// and long tails ask for yet others. fs wants its nominal width, sqrt(1/2) of it from 85° on, which leaves 0.14 to 0.3
/// where the cosine alone leaves 46 to 107.
///
/// lobe_of(l, width) makes the lobe with its nominal widths multiplied, integrand(l, v) = f cos theta_r. All candidates
/// are judged by the same points, drawn from all of them alike, so that a lobe too narrow to meet the others' tails is
/// charged for them.
template <class LobeOf, class Integrand>
[[nodiscard]] Fit best(double cos_i, const LobeOf& lobe_of, const Integrand& integrand) {
  constexpr std::size_t candidates = 16;
  constexpr std::size_t points_each = 16;
  constexpr double log_step = 0.34657359027997264;  // half an octave
  constexpr double log_least = -10.0 * log_step;
  std::array<double, candidates> second{};
  std::array<double, candidates> density{};
  double first = 0.0;
  std::size_t point = 0;
  for (std::size_t i = 0; i < points_each; ++i) {
    for (std::size_t k = 0; k < candidates; ++k) {
      const std::array<double, 3> u = cube_point(point++);
      const Direction l = light_at(cos_i, u[2]);
      const auto lobe = [&](std::size_t j) {
        return lobe_of(l, std::exp(log_least + static_cast<double>(j) * log_step));
      };
      const Direction v = lobe(k).draw(l, u[0], u[1]);
      if (v.z <= 0.0) continue;
      double mean = 0.0;
      for (std::size_t j = 0; j < candidates; ++j) mean += density[j] = defended_density(lobe(j), l, v);
      mean /= candidates;
      const double value = integrand(l, v);
      first += value / mean;
      for (std::size_t j = 0; j < candidates; ++j) second[j] += value / density[j] * (value / mean);
    }
  }
  const auto least = static_cast<std::size_t>(std::min_element(second.begin(), second.end()) - second.begin());
  const auto n = static_cast<double>(candidates * points_each);
  return {log_least + static_cast<double>(least) * log_step, first / n, second[least] / n};
}

}  // namespace goniofit::lobe_width
