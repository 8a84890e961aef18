// The inline functions of lanes against the C library's, over their whole ranges.

#include "support/lane_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "terms/scalar.h"

namespace goniofit {
namespace {

// Largest error in eps of f over [low, high], of arguments uniform or uniform in their logarithm.
template <class Real, class F, class Truth>
double worst_eps(const F& f, const Truth& truth, double low, double high, bool logarithmic = false) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double u = unit(random);
    const double x =
        logarithmic ? std::exp(std::log(low) + u * (std::log(high) - std::log(low))) : low + (high - low) * u;
    const auto rounded = static_cast<Real>(x);
    const auto want = truth(static_cast<long double>(rounded));
    const auto got = static_cast<long double>(f(Lane<Real>(rounded)).v);
    worst = std::max(worst, static_cast<double>(std::fabs(got / want - 1.0L)));
  }
  return worst / static_cast<double>(std::numeric_limits<Real>::epsilon());
}

template <class Real>
class LaneMath : public testing::Test {};
using Reals = testing::Types<double, float>;
TYPED_TEST_SUITE(LaneMath, Reals);

long double true_exp(long double x) { return std::exp(x); }
long double true_expm1(long double x) { return std::expm1(x); }
long double true_log(long double x) { return std::log(x); }
long double true_log1p(long double x) { return std::log1p(x); }
long double true_erfc(long double x) { return std::erfc(x); }

TYPED_TEST(LaneMath, ExponentialsAreRightToTwoEps) {
  using Real = TypeParam;
  constexpr bool single = std::is_same_v<Real, float>;
  const auto f = [](Lane<Real> x) { return exp(x); };
  EXPECT_LE(worst_eps<Real>(f, true_exp, single ? -63.0 : -689.0, single ? 87.0 : 708.0), 2.0);
  EXPECT_LE(worst_eps<Real>(f, true_exp, -1.0, 1.0), 2.0);
  const auto g = [](Lane<Real> x) { return expm1(x); };
  EXPECT_LE(worst_eps<Real>(g, true_expm1, -40.0, 2.0), 2.0);
  EXPECT_LE(worst_eps<Real>([&](Lane<Real> x) { return g(-x); }, [](long double x) { return true_expm1(-x); }, 1e-15,
                            1.0, true),
            2.0);
}

TYPED_TEST(LaneMath, LogarithmsAreRightToThreeEps) {
  using Real = TypeParam;
  constexpr bool single = std::is_same_v<Real, float>;
  const auto f = [](Lane<Real> x) { return log(x); };
  EXPECT_LE(worst_eps<Real>(f, true_log, single ? 1e-37 : 1e-307, single ? 1e37 : 1e307, true), 3.0);
  EXPECT_LE(worst_eps<Real>(f, true_log, 0.5, 2.0), 3.0);
  const auto g = [](Lane<Real> x) { return log1p(x); };
  EXPECT_LE(worst_eps<Real>(g, true_log1p, 1e-15, 1e15, true), 3.0);
  EXPECT_LE(worst_eps<Real>(g, true_log1p, -0.999, 0.5), 3.0);
}

TYPED_TEST(LaneMath, ArcSinesAreRightToTwoEps) {
  using Real = TypeParam;
  const auto f = [](Lane<Real> x) { return asin(x); };
  const auto truth = [](long double x) { return std::asin(x); };
  EXPECT_LE(worst_eps<Real>(f, truth, 1e-15, 0.70710678, true), 2.0);
  EXPECT_LE(worst_eps<Real>(f, truth, 0.1, 0.70710678), 2.0);
  EXPECT_TRUE(std::isfinite(asin(Lane<Real>(Real(1))).v)) << "a lane that another choice is made for";
}

// ln(1 - e^x) from where e^x is lost beside 1 to where 1 - e^x nearly vanishes.
TYPED_TEST(LaneMath, LogOfOneMinusExp) {
  using Real = TypeParam;
  const auto f = [](Lane<Real> x) {
    using namespace math;
    return log_one_minus_exp(Lane<Real>(-x));
  };
  const auto truth = [](long double x) { return x < 0.69L ? std::log(-std::expm1(-x)) : std::log1p(-std::exp(-x)); };
  EXPECT_LE(worst_eps<Real>(f, truth, 1e-6, 60.0, true), 4.0);
}

// The exponent x² is rounded: x² eps.
TYPED_TEST(LaneMath, ErfcIsRightToItsExponentsRounding) {
  using Real = TypeParam;
  const auto f = [](Lane<Real> x) { return erfc(x); };
  EXPECT_LE(worst_eps<Real>(f, true_erfc, 0.0, 2.0), 12.0);
  EXPECT_LE(worst_eps<Real>(f, true_erfc, 2.0, std::is_same_v<Real, float> ? 7.9 : 26.0), 700.0);
  const double far = static_cast<double>(f(Lane<Real>(1e30)).v);
  EXPECT_GE(far, 0.0);
  EXPECT_LE(far, 1e-28);
}

TYPED_TEST(LaneMath, BeyondTheRangeTheEndsHold) {
  using Real = TypeParam;
  EXPECT_GT(exp(Lane<Real>(-1e30)).v, Real(0));
  EXPECT_LT(exp(Lane<Real>(-1e30)).v, Real(1e-27));
  EXPECT_TRUE(std::isfinite(exp(Lane<Real>(1e30)).v));
  EXPECT_EQ(expm1(Lane<Real>(-1e30)).v, Real(-1));
  EXPECT_EQ(exp(Lane<Real>(0.0)).v, Real(1));
  EXPECT_EQ(expm1(Lane<Real>(0.0)).v, Real(0));
  EXPECT_EQ(log(Lane<Real>(1.0)).v, Real(0));
}

}  // namespace
}  // namespace goniofit
