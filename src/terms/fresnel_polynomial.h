#pragma once
// Exact Fresnel reflectance of one n + i kappa as a polynomial in u, the cosine between H and V, for vectorised loops:
// neither roots nor divisions nor branches.

#include <array>
#include <cstddef>

#include "polynomial.h"

namespace goniofit {

struct FresnelPolynomial {
  /// The lengths there are, each compiled into kernels of its own.
  static constexpr std::array<std::size_t, 7> lengths{8, 12, 16, 20, 24, 32, 40};

  std::size_t length = 0;                 ///< 0: none is within the tolerance, take fresnel_exact
  double error = 0.0;                     ///< largest found, relative to F
  std::array<double, 40> coefficients{};  ///< by power of 2u - 1
};

/// The shortest within `tolerance` of F, relatively, for all u in [0, 1]; tolerances below 1e-12 are not to be had.
/// None for total reflection, whose kink at the critical angle no polynomial follows, nor where F is 0 or nearly so
/// somewhere.
[[nodiscard]] FresnelPolynomial fit_fresnel(double n, double kappa, double tolerance);

/// F by the first `length` coefficients.
template <std::size_t length, class Real>
[[nodiscard]] [[gnu::always_inline]] inline Real fresnel_polynomial(const Real* coefficients, Real u) {
  return polynomial<length>(coefficients, u + u - Real(1));
}

}  // namespace goniofit
