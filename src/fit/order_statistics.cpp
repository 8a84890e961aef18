#include "fit/order_statistics.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "fit/clones.h"

namespace goniofit {

namespace {

// A sample's values between which the rank lies all but surely.
struct Bracket {
  double low, high;
};

constexpr std::size_t sampled = 255;

Bracket bracket_of(const std::vector<double>& values, std::size_t rank) {
  std::array<double, sampled> sample{};
  for (std::size_t i = 0; i < sampled; ++i) sample[i] = values[(2 * i + 1) * values.size() / (2 * sampled)];
  std::sort(sample.begin(), sample.end());
  constexpr std::size_t margin = 24;  // three standard deviations of a sample's median
  const std::size_t at = rank * sampled / values.size();
  return {sample[at < margin ? 0 : at - margin], sample[std::min(at + margin, sampled - 1)]};
}

struct Counts {
  std::size_t below, inside;
};

GONIOFIT_CLONES Counts count(const double* values, std::size_t n, Bracket bracket) noexcept {
  std::size_t below = 0;
  std::size_t not_above = 0;
  for (std::size_t i = 0; i < n; ++i) {
    below += values[i] < bracket.low ? 1 : 0;
    not_above += values[i] <= bracket.high ? 1 : 0;
  }
  return {below, not_above - below};
}

}  // namespace

// Of the values only those of a bracket about the rank are sorted out, without a branch that nobody can predict.
double value_at_rank(std::vector<double>& values, std::size_t rank) {
  const auto nth = [](std::vector<double>& from, std::size_t n) {
    const auto at = from.begin() + static_cast<std::ptrdiff_t>(n);
    std::nth_element(from.begin(), at, from.end());
    return *at;
  };
  if (values.size() < 4 * sampled) return nth(values, rank);
  const Bracket bracket = bracket_of(values, rank);
  const auto [below, inside] = count(values.data(), values.size(), bracket);
  if (rank < below || rank >= below + inside) return nth(values, rank);
  std::vector<double> middle(inside + 1);
  std::size_t place = 0;
  for (const double v : values) {
    middle[place] = v;
    place += v >= bracket.low && v <= bracket.high ? 1 : 0;
  }
  middle.pop_back();
  return nth(middle, rank - below);
}

std::size_t count_of_largest(std::vector<double>& values, double share) {
  const double total = std::accumulate(values.begin(), values.end(), 0.0);
  const double target = share * total;
  // All values as small as these together do not hold what the largest may leave.
  const double small = (1.0 - share) * total / static_cast<double>(std::max<std::size_t>(values.size(), 1));
  std::erase_if(values, [small](double v) { return v < small; });
  auto first = values.begin();
  auto last = values.end();
  double sum = 0.0;
  while (last - first > 32) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, std::greater<>());
    const double upper = std::accumulate(first, middle, 0.0);
    if (sum + upper >= target) {
      last = middle;
    } else {
      sum += upper;
      first = middle;
    }
  }
  std::sort(first, last, std::greater<>());
  while (first != values.end() && sum < target) sum += *first++;
  return static_cast<std::size_t>(first - values.begin());
}

}  // namespace goniofit
