#include "fit/noise_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "fit/order_statistics.h"
#include "support/radix_sort.h"

namespace goniofit {

namespace {

constexpr double smallest_noise = 1e-6;
// Standard deviation of a normal distribution over the median of its absolute value.
constexpr double sigma_of_median = 1.4826022185056018;

using Values = Eigen::Ref<const Eigen::VectorXd>;

double median(std::vector<double>& values) { return value_at_rank(values, values.size() / 2); }

struct NoiseClass {
  double f2, variance;
};

// Rows in the order of the sizes of f, those of equal size in their own, as far as anybody asks: by the exponent and
// ten bits of the fraction throughout, in full about the ranks asked for.
class SizeOrder {
 public:
  explicit SizeOrder(const Values& f) : order_(static_cast<std::size_t>(f.size())) {
    for (std::size_t i = 0; i < order_.size(); ++i)
      order_[i] = {key_of_size(std::fabs(f[static_cast<Eigen::Index>(i)])), i};
    radix_sort(order_, rough_bit);
  }
  [[nodiscard]] std::size_t size() const noexcept { return order_.size(); }
  /// The row at `rank`; all before it in full order come before it here too. Ranks have to ascend.
  Eigen::Index settle(std::size_t rank) {
    if (rank >= settled_) {
      const auto rough = [](const KeyedRow& r) { return r.key >> rough_bit; };
      const auto alike = std::equal_range(order_.begin(), order_.end(), order_[rank],
                                          [&](const KeyedRow& a, const KeyedRow& b) { return rough(a) < rough(b); });
      std::sort(alike.first, alike.second,
                [](const KeyedRow& a, const KeyedRow& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
      settled_ = static_cast<std::size_t>(alike.second - order_.begin());
    }
    return row(rank);
  }
  [[nodiscard]] Eigen::Index row(std::size_t rank) const noexcept {
    return static_cast<Eigen::Index>(order_[rank].row);
  }

 private:
  static constexpr unsigned rough_bit = 42;
  std::vector<KeyedRow> order_;
  std::size_t settled_ = 0;
};

std::vector<NoiseClass> classes_of(const Values& f, const Values& residual, double floor2) {
  SizeOrder order(f);
  const std::size_t count = std::clamp<std::size_t>(order.size() / 25, 1, 20);
  std::vector<NoiseClass> classes;
  std::vector<double> size;
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t first = c * order.size() / count;
    const std::size_t end = (c + 1) * order.size() / count;
    const double middle = f[order.settle(first + (end - first) / 2)];
    if (end < order.size()) order.settle(end);
    size.clear();
    for (std::size_t i = first; i < end; ++i) size.push_back(std::fabs(residual[order.row(i)]));
    const double sigma = sigma_of_median * median(size);
    classes.push_back({middle * middle, std::max(sigma * sigma, floor2)});
  }
  return classes;
}

}  // namespace

Noise estimate_noise(const Values& f, const Values& residual) {
  if (f.size() == 0) return {};
  const double scale2 = f.squaredNorm() / static_cast<double>(f.size());
  const double floor2 = smallest_noise * smallest_noise * scale2;
  const std::vector<NoiseClass> classes = classes_of(f, residual, std::max(floor2, 1e-300));
  // Least squares of variance = a2 + r2 f2 with errors proportional to the variance, both parts nonnegative. The errors
  // follow the line itself, not the classes: else low classes would count for more.
  double a2 = 0.0;
  double r2 = 0.0;
  for (int round = 0; round < 20; ++round) {
    double w = 0.0, wx = 0.0, wxx = 0.0, wy = 0.0, wxy = 0.0;
    for (const NoiseClass& c : classes) {
      const double expected = round == 0 ? c.variance : a2 + r2 * c.f2;
      const double weight = 1.0 / (expected * expected);
      w += weight;
      wx += weight * c.f2;
      wxx += weight * c.f2 * c.f2;
      wy += weight * c.variance;
      wxy += weight * c.f2 * c.variance;
    }
    const double determinant = w * wxx - wx * wx;
    const bool one = classes.size() < 2 || determinant <= 1e-12 * w * wxx;
    a2 = one ? 0.0 : (wy * wxx - wxy * wx) / determinant;
    r2 = one ? (wxx > 0.0 ? wxy / wxx : 0.0) : (w * wxy - wx * wy) / determinant;
    if (a2 < 0.0) {
      a2 = 0.0;
      r2 = wxy / wxx;
    } else if (r2 < 0.0) {
      r2 = 0.0;
      a2 = wy / w;
    }
    a2 = std::max(a2, std::max(floor2, 1e-300));
    r2 = std::max(r2, smallest_noise * smallest_noise);
  }
  return {std::sqrt(r2), std::sqrt(a2)};
}

double robust_spread(const Eigen::VectorXd& deviates) {
  if (deviates.size() == 0) return 0.0;
  const Eigen::VectorXd absolute = deviates.cwiseAbs();
  std::vector<double> size(absolute.begin(), absolute.end());
  return sigma_of_median * median(size);
}

}  // namespace goniofit
