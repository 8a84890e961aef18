#pragma once
// Sums over readings that noise is estimated from, vectorised as dot.h's. Private to reading_noise.

#include <cstddef>

namespace goniofit {

/// Squares of residuals to be explained by additive² * first + relative² * second, with the readings' leverages.
struct NoiseReadings {
  const double *first, *second, *square, *leverage;
  std::size_t size;
};

/// What is supposed of the noise: variances, or the squares themselves.
struct SupposedNoise {
  double additive2 = 0.0, relative2 = 0.0;
  bool by_squares = false;
  double floor = 0.0;  ///< added to every variance where it divides
};

/// Normal equations of the squares, each by its leverage over its variance squared.
struct NoiseEquations {
  double ff = 0.0, fs = 0.0, ss = 0.0, fy = 0.0, sy = 0.0;

  NoiseEquations& operator+=(const NoiseEquations& other) noexcept;
};
[[nodiscard]] NoiseEquations noise_equations(const NoiseReadings& r, const SupposedNoise& noise) noexcept;

/// Sums over w v, w square and (w v)², v the variances and w the leverages over these and the floor.
struct AgreementSums {
  double expected = 0.0, found = 0.0, squares = 0.0;
};
[[nodiscard]] AgreementSums agreement_sums(const NoiseReadings& r, const SupposedNoise& noise) noexcept;

}  // namespace goniofit
