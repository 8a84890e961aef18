#include "fit/residual_tests.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>

namespace goniofit {

namespace {

constexpr double sd_by_median = 1.4826;  // of a Gaussian: 1 / quantile(3/4)

// The middle of a group of readings of like fitted value.
struct NoiseGroup {
  double fitted2, sd2;
};

std::vector<NoiseGroup> noise_groups(const std::vector<double>& fitted, const std::vector<double>& residuals) {
  constexpr std::size_t smallest = 10;
  constexpr std::size_t most = 20;
  const std::size_t count = std::clamp<std::size_t>(fitted.size() / smallest, 1, most);
  std::vector<std::size_t> order(fitted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::fabs(fitted[a]) < std::fabs(fitted[b]); });
  std::vector<NoiseGroup> groups;
  for (std::size_t g = 0; g < count; ++g) {
    const std::size_t begin = g * order.size() / count;
    const std::size_t end = (g + 1) * order.size() / count;
    std::vector<double> sizes;
    for (std::size_t i = begin; i < end; ++i) sizes.push_back(std::fabs(residuals[order[i]]));
    const double sd = sd_by_median * median_of(sizes);
    const double middle = fitted[order[begin + (end - begin) / 2]];
    groups.push_back({middle * middle, sd * sd});
  }
  return groups;
}

// sd² = additive² + relative² f², least squares of the relative differences, neither below zero.
ResidualNoise through(const std::vector<NoiseGroup>& groups) {
  double largest = 0.0;
  for (const NoiseGroup& g : groups) largest = std::max(largest, g.sd2);
  if (largest == 0.0) return {};
  double w11 = 0.0, w12 = 0.0, w22 = 0.0, b1 = 0.0, b2 = 0.0;
  for (const NoiseGroup& g : groups) {
    const double w = 1.0 / std::max(g.sd2, 1e-12 * largest);
    const double x = w * g.fitted2;
    w11 += w * w, w12 += w * x, w22 += x * x, b1 += w * w * g.sd2, b2 += x * w * g.sd2;
  }
  const double determinant = w11 * w22 - w12 * w12;
  double additive2 = determinant > 1e-12 * w11 * w22 ? (b1 * w22 - b2 * w12) / determinant : b1 / w11;
  double relative2 = determinant > 1e-12 * w11 * w22 ? (b2 * w11 - b1 * w12) / determinant : 0.0;
  if (additive2 < 0.0) additive2 = 0.0, relative2 = b2 / w22;
  if (relative2 < 0.0) relative2 = 0.0, additive2 = b1 / w11;
  return {std::sqrt(relative2), std::sqrt(additive2)};
}

}  // namespace

void RunsTest::add_line(const std::vector<double>& residuals) {
  int last = 0;
  for (const double r : residuals) {
    const int sign = r > 0.0 ? 1 : r < 0.0 ? -1 : 0;
    if (sign == 0) continue;
    ++readings;
    if (last == 0) ++lines;
    if (sign != last) ++runs;
    last = sign;
  }
}

double RunsTest::p() const {
  const auto n = static_cast<double>(comparisons());
  const auto changes = static_cast<double>(runs - lines);
  // Binomial distribution function by the incomplete beta function.
  return changes >= n ? 1.0 : boost::math::ibeta(n - changes, changes + 1.0, 0.5);
}

double ResidualNoise::sd(double fitted) const noexcept { return std::hypot(relative * fitted, additive); }

ResidualNoise residual_noise(const std::vector<double>& fitted, const std::vector<double>& residuals) {
  if (fitted.empty()) return {};
  ResidualNoise noise = through(noise_groups(fitted, residuals));
  // What the line through the groups misses on the whole: half of the residuals lie within 0.674 of it.
  std::vector<double> parts;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (const double sd = noise.sd(fitted[i]); sd > 0.0) parts.push_back(std::fabs(residuals[i]) / sd);
  }
  if (parts.empty()) return noise;
  const double scale = sd_by_median * median_of(parts);
  return {scale * noise.relative, scale * noise.additive};
}

ReducedChiSquare reduced_chi_square(double chi_square, std::size_t degrees_of_freedom) {
  const auto dof = static_cast<double>(degrees_of_freedom);
  const boost::math::chi_squared distribution(dof);
  return {chi_square / dof, degrees_of_freedom, boost::math::quantile(distribution, 0.025) / dof,
          boost::math::quantile(distribution, 0.975) / dof};
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace goniofit
