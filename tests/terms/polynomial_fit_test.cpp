#include "terms/polynomial_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "terms/fresnel.h"

namespace goniofit {
namespace {

TEST(PolynomialFit, HoldsTheToleranceBetweenItsGrid) {
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    for (const auto& [n, kappa] : {std::pair{1.5, 0.0}, {2.4, 0.0}, {0.958, 6.69}}) {
      const auto f = [n = n, kappa = kappa](double u) { return fresnel_exact(n, kappa, u, 1.0 - u); };
      const auto p = fit_polynomial(f, 0.0, 1.0, tolerance, ErrorMeasure::relative, 44, PolynomialArithmetic::binary64);
      ASSERT_TRUE(p) << n << " " << tolerance;
      double worst = 0.0;
      for (int i = 0; i <= 100000; ++i) {
        const double u = i * 1e-5;
        worst = std::max(worst, std::fabs((*p)(u) / f(u) - 1.0));
      }
      EXPECT_LE(worst, 1.02 * tolerance) << n;
      EXPECT_LE(p->error, tolerance);
    }
  }
}

TEST(PolynomialFit, APolynomialIsItself) {
  const auto f = [](double x) { return 1.0 + x * (2.0 - 3.0 * x * x); };
  const auto p = fit_polynomial(f, -1.0, 3.0, 1e-12, ErrorMeasure::absolute, 12, PolynomialArithmetic::binary64);
  ASSERT_TRUE(p);
  EXPECT_EQ(p->c.size(), 4U);
  EXPECT_NEAR((*p)(2.5), f(2.5), 1e-12);
}

// Total reflection has a kink, and single precision ends at seven digits.
TEST(PolynomialFit, SaysWhenItCannot) {
  const auto total = [](double u) { return fresnel_exact(0.7, 0.0, u, 1.0 - u); };
  EXPECT_FALSE(fit_polynomial(total, 0.0, 1.0, 1e-4, ErrorMeasure::relative, 44, PolynomialArithmetic::binary64));
  const auto smooth = [](double u) { return std::exp(u); };
  EXPECT_TRUE(fit_polynomial(smooth, 0.0, 1.0, 1e-6, ErrorMeasure::relative, 44, PolynomialArithmetic::binary32));
  EXPECT_FALSE(fit_polynomial(smooth, 0.0, 1.0, 1e-9, ErrorMeasure::relative, 44, PolynomialArithmetic::binary32));
}

}  // namespace
}  // namespace goniofit
