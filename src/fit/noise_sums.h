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

/// What fits leave of noise: residuals, the variance supposed of each, and what the fit adds to it, J_i V J_iᵀ.
struct LeftNoise {
  const double *residual, *variance, *added;
  std::size_t size;
};
/// square = residual² / left, left = 1 - 2 leverage + added / variance and no less than `least_left`; where it is less
/// the leverage becomes 0.
void set_squares_left(const LeftNoise& r, double least_left, double* leverage, double* square) noexcept;

}  // namespace goniofit
