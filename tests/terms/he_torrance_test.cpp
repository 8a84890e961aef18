// W(g, x) of He et al. 1991: the series in double, the saddle point and the fast tier against 50 digits.

#include "terms/he_torrance.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace goniofit {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

// The definition: every term from j = 1 until they have fallen 45 digits below the largest.
LogW<Big> definition(double log_g, double x) {
  const Big g = exp(Big(log_g));
  Big poisson = exp(Big(-g));  // g^j e^-g/j!
  Big sum = 0, sum_j = 0, sum_inverse = 0, largest = 0;
  for (int j = 1;; ++j) {
    poisson *= g / j;
    const Big term = poisson / j * exp(Big(-Big(x) / j));
    sum += term;
    sum_j += term * j;
    sum_inverse += term / j;
    if (term > largest) {
      largest = term;
    } else if (j > g && term < largest * Big("1e-45")) {
      break;
    }
  }
  return {Big(log(sum)), Big(sum_j / sum - g), Big(-sum_inverse / sum)};
}

// Above g = 2000 by the saddle point, which the test `SaddleMeetsTheDefinition` holds to the definition.
LogW<Big> truth(double log_g, double x) {
  if (log_g < std::log(2000.0)) return definition(log_g, x);
  const Big lg(log_g), bx(x);
  return he_torrance::log_w_at_saddle(lg, bx, he_torrance::saddle_exponent(lg, bx));
}

// The largest x at which ln W is above `least`, for sampling.
double reach(double log_g, double least) {
  double low = 0.0, high = 1.0;
  while (log_he_torrance_series(log_g, high) > least) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (log_he_torrance_series(log_g, middle) > least ? low : high) = middle;
  }
  return low;
}

struct Place {
  double log_g, x;
};

// ln g from `low` to `high` in strata; in each, x = 0 and x at strata of the depth of ln W, shallow ones favoured, down
// to W = 1e-290.
std::vector<Place> places(double low, double high, int strata, int depths, unsigned seed) {
  constexpr double deepest = -667.0;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Place> out;
  for (int i = 0; i < strata; ++i) {
    const double log_g = low + (high - low) * (i + unit(random)) / strata;
    const double top = log_he_torrance_series(log_g, 0.0);
    out.push_back({log_g, 0.0});
    for (int k = 0; k < depths; ++k) {
      const double fraction = (k + unit(random)) / depths;
      out.push_back({log_g, reach(log_g, top + (deepest - top) * fraction * fraction * fraction)});
    }
  }
  return out;
}

// Largest and RMS of one kind of error.
class Errors {
 public:
  explicit Errors(std::string name) : name_(std::move(name)) {}
  ~Errors() {
    std::printf("  %-34s %6d places, max %.2g at ln g %.6g, x %.6g, RMS %.2g\n", name_.c_str(), count_, worst_,
                where_.log_g, where_.x, std::sqrt(sum_ / std::max(count_, 1)));
  }
  Errors(const Errors&) = delete;
  Errors& operator=(const Errors&) = delete;

  void add(const Big& error, const Place& at) {
    const double e = std::fabs(static_cast<double>(error));
    ++count_;
    sum_ += e * e;
    if (!(e <= worst_)) {
      worst_ = std::isnan(e) ? HUGE_VAL : e;
      where_ = at;
    }
  }
  [[nodiscard]] double worst() const { return worst_; }

 private:
  std::string name_;
  int count_ = 0;
  double worst_ = 0.0, sum_ = 0.0;
  Place where_{};
};

struct Comparison {
  explicit Comparison(const std::string& name)
      : value(name + " ln W"), by_log_g(name + " d/d ln g"), by_x(name + " d/dx") {}
  Errors value, by_log_g, by_x;

  // W relatively (that is ln W absolutely, over `scale`), d/d ln g over 1 + |d|, d/dx relatively.
  template <class T>
  void add(const LogW<T>& got, const LogW<Big>& want, const Place& at, const Big& scale = 1) {
    value.add((got.value - want.value) / scale, at);
    by_log_g.add((got.by_log_g - want.by_log_g) / (1 + abs(want.by_log_g)), at);
    by_x.add(got.by_x / want.by_x - 1, at);
  }
};

TEST(HeTorranceSeries, DoubleMeetsFiftyDigits) {
  Comparison c("series");
  std::vector<Place> all = places(std::log(1e-12), std::log(500.0), 40, 12, 1);
  for (const Place& p : places(std::log(500.0), std::log(1e6), 20, 4, 2)) all.push_back(p);
  for (const Place& p : places(std::log(1e7), std::log(1e8), 2, 1, 9)) all.push_back(p);
  for (const Place& p : all) {
    const LogW<Big> want = truth(p.log_g, p.x);
    const LogW<double> got = log_he_torrance_series_derivatives(p.log_g, p.x);
    c.add(got, want, p, 1 + abs(want.value));
    EXPECT_EQ(log_he_torrance_series(p.log_g, p.x), got.value);
  }
  EXPECT_LT(c.value.worst(), 1e-14);
  EXPECT_LT(c.by_log_g.worst(), 1e-13);
  EXPECT_LT(c.by_x.worst(), 1e-13);
}

TEST(HeTorranceSeries, FiftyDigitsAreFiftyDigits) {
  Comparison c("series, 50 digits");
  for (const Place& p : places(std::log(1e-12), std::log(1000.0), 25, 4, 3)) {
    c.add(log_he_torrance_series_derivatives(Big(p.log_g), Big(p.x)), definition(p.log_g, p.x), p);
  }
  EXPECT_LT(c.value.worst(), 1e-43);
  EXPECT_LT(c.by_log_g.worst(), 1e-43);
  EXPECT_LT(c.by_x.worst(), 1e-43);
}

// Six corrections leave 5040/J^7, 1e-20 at J = 2400, so a wrong coefficient shows in any of them.
TEST(HeTorranceSaddle, SaddleMeetsTheDefinition) {
  Comparison c("saddle, 50 digits, g = 2400");
  const double log_g = std::log(2400.0);
  for (const double x : {0.0, 50.0, 2400.0, 1e5, 1e6, 1e7, 1e8}) {
    const Big lg(log_g), bx(x);
    c.add(he_torrance::log_w_at_saddle(lg, bx, he_torrance::saddle_exponent(lg, bx)), definition(log_g, x), {log_g, x});
  }
  EXPECT_LT(c.value.worst(), 2e-20);
  EXPECT_LT(c.by_log_g.worst(), 2e-19);
  EXPECT_LT(c.by_x.worst(), 2e-19);
}

// At x = 0, W = e^-g (Ei(g) - ln g - gamma), and Q_n at v = 1 is n!; at v = 0 they are the coefficients of 1/Gamma.
TEST(HeTorranceSaddle, CorrectionsHaveTheirKnownEnds) {
  const auto ends = [](const auto& term, double at_1, double at_0) {
    EXPECT_NEAR(term.at(1.0)[0], at_1, 1e-11 * at_1);
    EXPECT_NEAR(term.at(0.0)[0], at_0, 1e-15);
  };
  ends(he_torrance::saddle_1, 1.0, -1.0 / 12.0);
  ends(he_torrance::saddle_2, 2.0, 1.0 / 288.0);
  ends(he_torrance::saddle_3, 6.0, 139.0 / 51840.0);
  ends(he_torrance::saddle_4, 24.0, -571.0 / 2488320.0);
  ends(he_torrance::saddle_5, 120.0, -163879.0 / 209018880.0);
  ends(he_torrance::saddle_6, 720.0, 5246819.0 / 75246796800.0);
}

TEST(HeTorrance, MeetsFiftyDigits) {
  Comparison c("fast");
  std::vector<Place> all = places(std::log(1e-12), -2.0, 60, 15, 4);
  for (const Place& p : places(-2.0, 3.6, 84, 10, 5)) all.push_back(p);
  for (const Place& p : places(3.6, std::log(1e6), 30, 10, 6)) all.push_back(p);
  for (const Place& p : all) {
    const LogW<Big> want = truth(p.log_g, p.x);
    const HeTorranceW got = he_torrance_log_w_derivatives(p.log_g, p.x);
    c.add(got, want, p);
    EXPECT_NEAR(he_torrance_log_w(p.log_g, p.x), got.value, 1e-11);
  }
  EXPECT_LT(c.value.worst(), 5e-10);
  EXPECT_LT(c.by_log_g.worst(), 1e-7);
  EXPECT_LT(c.by_x.worst(), 1e-7);
}

// The same against the series in double, at enough places to meet each polynomial many times.
TEST(HeTorrance, MeetsTheSeriesEverywhere) {
  Comparison c("fast, dense");
  std::vector<Place> all = places(-2.2, 3.6, 600, 50, 7);
  for (const Place& p : places(3.6, 8.0, 60, 60, 8)) all.push_back(p);
  for (const Place& p : all) {
    const LogW<double> s = log_he_torrance_series_derivatives(p.log_g, p.x);
    c.add(he_torrance_log_w_derivatives(p.log_g, p.x), {Big(s.value), Big(s.by_log_g), Big(s.by_x)}, p);
  }
  EXPECT_LT(c.value.worst(), 5e-10);
  EXPECT_LT(c.by_log_g.worst(), 1e-7);
  EXPECT_LT(c.by_x.worst(), 1e-7);
}

// Across every edge in ln g: both sides of one unit in the last place.
TEST(HeTorrance, HasNoStepWhereRegimesMeetInG) {
  Errors value("step in ln W at an edge in ln g"), slope("step in d/d ln g");
  std::vector<double> edges{3.6, std::log(125.0), -2.0};
  for (int r = 1; r < 14; ++r) edges.push_back(-2.0 + 0.4 * r);
  for (const double edge : edges) {
    for (double fraction = 0.0; fraction <= 1.0; fraction += 0.02) {
      const double x = fraction > 0.0 ? reach(edge, -667.0 * fraction) : 0.0;
      const HeTorranceW below = he_torrance_log_w_derivatives(edge - 1e-14, x);
      const HeTorranceW above = he_torrance_log_w_derivatives(edge + 1e-14, x);
      value.add(Big(above.value - below.value - 2e-14 * above.by_log_g), {edge, x});
      slope.add(Big((above.by_log_g - below.by_log_g) / (1.0 + std::fabs(above.by_log_g))), {edge, x});
    }
  }
  EXPECT_LT(value.worst(), 1e-9);
  EXPECT_LT(slope.worst(), 1e-6);
}

// Across the edges in x, found as places of the representable grid: v = 1 + h x changes its quarter octave.
TEST(HeTorrance, HasNoStepWhereRegimesMeetInX) {
  Errors value("step in ln W along x"), slope("step in d/dx");
  for (const double log_g : {-3.0, -1.9, -0.5, 0.77, 2.0, 3.3, 4.0, 5.5}) {
    const double end = reach(log_g, -690.0);  // past the end of the polynomials
    for (double x = 1e-3; x < end; x *= 1.0 + 1e-3) {
      const double next = x * (1.0 + 1e-3), h = next - x;
      const HeTorranceW a = he_torrance_log_w_derivatives(log_g, x), b = he_torrance_log_w_derivatives(log_g, next);
      const LogW<double> s = log_he_torrance_series_derivatives(log_g, x),
                         t = log_he_torrance_series_derivatives(log_g, next);
      value.add(Big((b.value - a.value) - (t.value - s.value)), {log_g, x});
      slope.add(Big(((b.by_x - a.by_x) - (t.by_x - s.by_x)) / (std::fabs(s.by_x))), {log_g, h});
    }
  }
  EXPECT_LT(value.worst(), 1e-9);
  EXPECT_LT(slope.worst(), 1e-7);
}

void expect_near(double log_g, double x, const LogW<Big>& want) {
  for (const LogW<double>& w :
       {he_torrance_log_w_derivatives(log_g, x), log_he_torrance_series_derivatives(log_g, x)}) {
    EXPECT_LT(static_cast<double>(abs(w.value / want.value - 1)), 1e-13) << log_g << " " << x;
    EXPECT_LT(static_cast<double>(abs(w.by_log_g / want.by_log_g - 1)), 1e-9) << log_g << " " << x;
    EXPECT_LT(static_cast<double>(abs(w.by_x / want.by_x - 1)), 1e-9) << log_g << " " << x;
  }
}

TEST(HeTorrance, IsOneSummandWhereGIsTiny) {
  expect_near(-1e5, 0.0, {-1e5, 1, -1});
  expect_near(-1e4, 0.0, {-1e4, 1, -1});
  expect_near(-1e5, 1e5, {-2e5, 1, -1});
  expect_near(-1e4, 20200.0, {-20000 - log(Big(4)) - 10100, 2, -0.5});
  expect_near(-700.0, 1.0, {-701, 1, -1});
  // The peak among 316 and its neighbours, each e^1e5/316 apart at equal x/j: e^-g/(316! 316) g^316 e^(-x/316).
  Big want = -Big(316) * 100000 - Big(1e10) / 316 - log(Big(316));
  for (int k = 2; k <= 316; ++k) want -= log(Big(k));
  expect_near(-1e5, 1e10, {want, 316, -Big(1) / 316});
}

// At peaks of 1e100 the saddle point leaves nothing out at 50 digits, and the test above holds it to the definition.
TEST(HeTorrance, IsRightAtHugeX) {
  for (const double log_g : {-1e5, -1e4, -700.0, -10.0, 0.0, 3.0, 10.0, std::log(1e8), 700.0}) {
    const Big lg(log_g), x(1e300);
    expect_near(log_g, 1e300, he_torrance::log_w_at_saddle(lg, x, he_torrance::saddle_exponent(lg, x)));
  }
}

// W = e^-g (Ei(g) - ln g - gamma) at x = 0: (1 + 1/g + 2/g² + 6/g³ ...)/g.
TEST(HeTorrance, IsTheExponentialIntegralAtGreatG) {
  const double log_g = std::log(1e8);
  const Big r = exp(-Big(log_g));
  const Big value = log(Big(1 + r * (1 + r * (2 + r * 6)))) - log_g;
  const Big by_log_g = -(1 + r * (2 + r * (6 + r * 24))) / (1 + r * (1 + r * (2 + r * 6)));
  const HeTorranceW fast = he_torrance_log_w_derivatives(log_g, 0.0);
  const LogW<double> series = log_he_torrance_series_derivatives(log_g, 0.0);
  EXPECT_LT(static_cast<double>(abs(fast.value / value - 1)), 1e-11);
  EXPECT_LT(static_cast<double>(abs(series.value / value - 1)), 1e-14);
  EXPECT_LT(static_cast<double>(abs(series.by_log_g / by_log_g - 1)), 1e-13);
  EXPECT_LT(static_cast<double>(abs(fast.by_log_g / by_log_g - 1)), 1e-9);
}

TEST(HeTorrance, IsNeverNan) {
  std::vector<double> log_gs{-1e5, -1e4, -746.0, -700.0, -30.0,         -2.0,  -1e-9,
                             0.0,  2.5,  3.6,    9.0,    std::log(1e8), 700.0, 1e4};
  for (const double edge : {-2.0, 3.6}) log_gs.push_back(std::nextafter(edge, -HUGE_VAL));
  for (const double log_g : log_gs) {
    for (const double x : {0.0, 5e-324, 1e-300, 1e-9, 1.0, 700.0, 1e4, 1e6, 1e9, 1e15, 1e100, 1e300,
                           std::numeric_limits<double>::max()}) {
      const HeTorranceW w = he_torrance_log_w_derivatives(log_g, x);
      EXPECT_TRUE(w.value <= 0.0 && std::isfinite(w.value)) << log_g << " " << x << " " << w.value;
      EXPECT_TRUE(std::isfinite(w.by_log_g)) << log_g << " " << x << " " << w.by_log_g;
      EXPECT_TRUE(w.by_x <= 0.0 && std::isfinite(w.by_x)) << log_g << " " << x << " " << w.by_x;
      EXPECT_NEAR(he_torrance_log_w(log_g, x) / w.value, 1.0, 1e-11) << log_g << " " << x;
    }
  }
}

TEST(HeTorrance, DualNumbersCarryTheDerivatives) {
  using Dual = ceres::Jet<double, 2>;
  for (const double log_g : {-5.0, 0.3, 3.0, 6.0}) {
    const double x = 3.0;
    const HeTorranceW w = he_torrance_log_w_derivatives(log_g, x);
    const Dual d = log_he_torrance(Dual(log_g, 0), Dual(x, 1));
    EXPECT_EQ(d.a, log_he_torrance(log_g, x));
    EXPECT_EQ(d.v[0], w.by_log_g);
    EXPECT_EQ(d.v[1], w.by_x);
    const Dual chained = log_he_torrance(Dual(log_g, 0), 2.0 * Dual(1.5, 1));
    EXPECT_NEAR(chained.v[1], 2.0 * w.by_x, 1e-14);
  }
}

// W falls in x and, under the summand's weights, d ln W/dx = -E[1/j] lies in [-1, 0).
TEST(HeTorrance, FallsWithX) {
  for (double log_g = -4.0; log_g < 12.0; log_g += 0.173) {
    double last = HUGE_VAL;
    for (double x = 0.0; x < 1e5; x = 1.07 * x + 0.01) {
      const HeTorranceW w = he_torrance_log_w_derivatives(log_g, x);
      EXPECT_LT(w.value, last);
      EXPECT_LT(w.by_x, 0.0);
      EXPECT_GE(w.by_x, -1.0 - 1e-9);
      last = w.value;
    }
  }
}

// g W -> e^-y as g grows: LT's rough limit, from which D differs by some 1/g.
TEST(HeTorrance, TendsToTheRoughLimit) {
  for (const double log_g : {std::log(1e4), std::log(1e6), std::log(1e8)}) {
    const double g = std::exp(log_g);
    for (const double y : {0.0, 0.5, 1.0, 2.0, 4.0}) {
      // Order 1: h(M) = e^(-x/M)/M, h + g h''/2 at M = g.
      const double order_1 = std::log1p((1.0 - 2.0 * y + 0.5 * y * y) / g);
      EXPECT_NEAR(he_torrance_log_w(log_g, y * g) + log_g, -y + order_1, 60.0 / (g * g) + 1e-13);
    }
  }
}

}  // namespace
}  // namespace goniofit
