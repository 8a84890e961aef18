#include "fit/noise_sums.h"

#include <array>

#include "fit/clones.h"

namespace goniofit {

namespace {

// Sums in lanes by position, as many as there are in flight: see dot().
constexpr std::size_t lanes = 8;
using Lanes = std::array<double, lanes>;

double total(const Lanes& l) noexcept {
  double sum = 0.0;
  for (const double part : l) sum += part;
  return sum;
}

[[gnu::always_inline]] inline double variance_at(const NoiseReadings& r, const SupposedNoise& n,
                                                 std::size_t i) noexcept {
  return n.by_squares ? r.square[i] : n.additive2 * r.first[i] + n.relative2 * r.second[i];
}

struct EquationLanes {
  Lanes ff{}, fs{}, ss{}, fy{}, sy{};

  [[gnu::always_inline]] inline void add(const NoiseReadings& r, const SupposedNoise& n, std::size_t i,
                                         std::size_t k) noexcept {
    const double error = variance_at(r, n, i) + n.floor;
    const double g = error > 0.0 ? r.leverage[i] / (error * error) : 0.0;
    const double gf = g * r.first[i];
    const double gs = g * r.second[i];
    ff[k] += gf * r.first[i];
    fs[k] += gf * r.second[i];
    ss[k] += gs * r.second[i];
    fy[k] += gf * r.square[i];
    sy[k] += gs * r.square[i];
  }
};

struct AgreementLanes {
  Lanes expected{}, found{}, squares{};

  [[gnu::always_inline]] inline void add(const NoiseReadings& r, const SupposedNoise& n, std::size_t i,
                                         std::size_t k) noexcept {
    const double variance = variance_at(r, n, i);
    const double floored = variance + n.floor;
    const double weight = floored > 0.0 ? r.leverage[i] / floored : 0.0;
    expected[k] += weight * variance;
    found[k] += weight * r.square[i];
    squares[k] += weight * variance * (weight * variance);
  }
};

template <class Sums>
[[gnu::always_inline]] inline void add_all(const NoiseReadings& r, const SupposedNoise& n, Sums& sums) noexcept {
  std::size_t i = 0;
  for (; i + lanes <= r.size; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sums.add(r, n, i + k, k);
  }
  for (std::size_t k = 0; i < r.size; ++i, ++k) sums.add(r, n, i, k);
}

}  // namespace

NoiseEquations& NoiseEquations::operator+=(const NoiseEquations& other) noexcept {
  ff += other.ff, fs += other.fs, ss += other.ss, fy += other.fy, sy += other.sy;
  return *this;
}

GONIOFIT_CLONES NoiseEquations noise_equations(const NoiseReadings& r, const SupposedNoise& noise) noexcept {
  EquationLanes sums;
  add_all(r, noise, sums);
  return {total(sums.ff), total(sums.fs), total(sums.ss), total(sums.fy), total(sums.sy)};
}

GONIOFIT_CLONES AgreementSums agreement_sums(const NoiseReadings& r, const SupposedNoise& noise) noexcept {
  AgreementLanes sums;
  add_all(r, noise, sums);
  return {total(sums.expected), total(sums.found), total(sums.squares)};
}

}  // namespace goniofit
