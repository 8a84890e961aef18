#include "fit/noise_sums.h"

#include <array>

#include "fit/clones.h"

namespace goniofit {

namespace {

// Sums in lanes by position, as many as there are in flight: see dot().
constexpr std::size_t lanes = 16;
using Lanes = std::array<double, lanes>;

double total(const Lanes& l) noexcept {
  double sum = 0.0;
  for (const double part : l) sum += part;
  return sum;
}

// weight / divisor, 0 where there is nothing to divide by. Without a branch: the loops about it are vectorised.
[[gnu::always_inline]] inline double over(double weight, double divisor, bool divides) noexcept {
  return (divides ? weight : 0.0) / (divides ? divisor : 1.0);
}

struct Reading {
  double first, second, square, leverage, variance, floored;
};

struct EquationLanes {
  Lanes ff{}, fs{}, ss{}, fy{}, sy{};

  [[gnu::always_inline]] inline void add(const Reading& r, std::size_t k) noexcept {
    const double g = over(r.leverage, r.floored * r.floored, r.floored > 0.0);
    const double gf = g * r.first;
    const double gs = g * r.second;
    ff[k] += gf * r.first;
    fs[k] += gf * r.second;
    ss[k] += gs * r.second;
    fy[k] += gf * r.square;
    sy[k] += gs * r.square;
  }
};

struct AgreementLanes {
  Lanes expected{}, found{}, squares{};

  [[gnu::always_inline]] inline void add(const Reading& r, std::size_t k) noexcept {
    const double weight = over(r.leverage, r.floored, r.floored > 0.0);
    const double of_variance = weight * r.variance;
    expected[k] += of_variance;
    found[k] += weight * r.square;
    squares[k] += of_variance * of_variance;
  }
};

template <bool by_squares, class Sums>
[[gnu::always_inline]] inline Sums sums_of(const NoiseReadings r, const SupposedNoise n) noexcept {
  Sums sums;
  const auto add = [&](std::size_t i, std::size_t k) [[gnu::always_inline]] {
    const double variance = by_squares ? r.square[i] : n.additive2 * r.first[i] + n.relative2 * r.second[i];
    sums.add({r.first[i], r.second[i], r.square[i], r.leverage[i], variance, variance + n.floor}, k);
  };
  std::size_t i = 0;
  for (; i + lanes <= r.size; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) add(i + k, k);
  }
  for (std::size_t k = 0; i < r.size; ++i, ++k) add(i, k);
  return sums;
}

}  // namespace

NoiseEquations& NoiseEquations::operator+=(const NoiseEquations& other) noexcept {
  ff += other.ff, fs += other.fs, ss += other.ss, fy += other.fy, sy += other.sy;
  return *this;
}

GONIOFIT_CLONES NoiseEquations noise_equations(const NoiseReadings& r, const SupposedNoise& noise) noexcept {
  const EquationLanes sums =
      noise.by_squares ? sums_of<true, EquationLanes>(r, noise) : sums_of<false, EquationLanes>(r, noise);
  return {total(sums.ff), total(sums.fs), total(sums.ss), total(sums.fy), total(sums.sy)};
}

GONIOFIT_CLONES AgreementSums agreement_sums(const NoiseReadings& r, const SupposedNoise& noise) noexcept {
  const AgreementLanes sums =
      noise.by_squares ? sums_of<true, AgreementLanes>(r, noise) : sums_of<false, AgreementLanes>(r, noise);
  return {total(sums.expected), total(sums.found), total(sums.squares)};
}

GONIOFIT_CLONES void set_squares_left(const LeftNoise& r, double least_left, double* leverage,
                                      double* square) noexcept {
  const LeftNoise from = r;
  for (std::size_t i = 0; i < from.size; ++i) {
    const double v = from.variance[i];
    const bool known = v > 0.0;
    const double quotient = from.added[i] / (known ? v : 1.0);
    const double left = known ? 1.0 - 2.0 * leverage[i] + quotient : 1.0;
    const bool tells = !(left < least_left);
    square[i] = from.residual[i] * from.residual[i] / (tells ? left : least_left);
    leverage[i] = tells ? leverage[i] : 0.0;
  }
}

}  // namespace goniofit
