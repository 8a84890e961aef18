// Fresnel reflectance as a polynomial against the closed form, for the paper's materials and the corners.

#include "terms/fresnel_polynomial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "terms/fresnel.h"

namespace goniofit {
namespace {

struct Optics {
  double n, kappa;
};

double evaluate(const FresnelPolynomial& p, double u) {
  double value = NAN;
  const auto with_length = [&]<std::size_t length>() {
    if (p.length == length) value = fresnel_polynomial<length>(p.coefficients.data(), u);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (with_length.template operator()<FresnelPolynomial::lengths[i]>(), ...);
  }
  (std::make_index_sequence<FresnelPolynomial::lengths.size()>());
  return value;
}

double worst(const FresnelPolynomial& p, const Optics& o) {
  double worst = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    const double u = i / 20000.0;
    const double error = std::fabs(evaluate(p, u) / fresnel_exact(o.n, o.kappa, u, 1.0 - u) - 1.0);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

TEST(FresnelPolynomial, MeetsTheClosedForm) {
  for (const Optics o : {Optics{1.5, 0.0}, {1.7, 0.0}, {2.4, 0.0}, {1.47, 7.79}, {0.958, 6.69}, {0.618, 5.47}}) {
    for (const double tolerance : {1e-9, 1e-4}) {
      const FresnelPolynomial p = fit_fresnel(o.n, o.kappa, tolerance);
      ASSERT_GT(p.length, 0U) << o.n << " " << o.kappa << " " << tolerance;
      const double found = worst(p, o);
      std::printf("  n %.3f + %.2fi, tolerance %.0e: %zu coefficients, %.2g\n", o.n, o.kappa, tolerance, p.length,
                  found);
      EXPECT_LE(p.error, tolerance);
      EXPECT_LT(found, 1.1 * tolerance);
    }
  }
}

TEST(FresnelPolynomial, SaysWhereThereIsNone) {
  EXPECT_EQ(fit_fresnel(0.8, 0.0, 1e-4).length, 0U);     // total reflection
  EXPECT_EQ(fit_fresnel(1.0, 0.0, 1e-4).length, 0U);     // F = 0
  EXPECT_EQ(fit_fresnel(1.0001, 0.0, 1e-9).length, 0U);  // all of it at grazing
}

}  // namespace
}  // namespace goniofit
