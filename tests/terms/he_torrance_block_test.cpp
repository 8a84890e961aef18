// ln W of whole blocks against the series and the tier for single values: every region, its borders, all instruction
// sets that this processor has.

#include "terms/he_torrance_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "terms/he_torrance.h"
#include "terms/he_torrance_regions.h"

namespace goniofit {
namespace {

using enum HeTorranceAccuracy;

constexpr double tolerance_of(HeTorranceAccuracy a) { return a == fine ? 1e-9 : 1e-4; }

std::vector<InstructionSet> available() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet s : all_instruction_sets) {
    if (s <= best_instruction_set()) sets.push_back(s);
  }
  return sets;
}

struct Places {
  std::vector<double> log_g, x;

  void add(double lg, double at) {
    log_g.push_back(lg);
    x.push_back(at);
  }
  [[nodiscard]] std::size_t size() const { return x.size(); }

  [[nodiscard]] std::vector<double> series() const {
    std::vector<double> w(size());
    for (std::size_t i = 0; i < size(); ++i) w[i] = log_he_torrance_series(log_g[i], x[i]);
    return w;
  }
  [[nodiscard]] std::vector<double> block(HeTorranceAccuracy a, InstructionSet s) const {
    std::vector<double> w(size());
    log_he_torrance_block(log_g.data(), x.data(), size(), w.data(), a, s);
    return w;
  }
};

// Where ln W = `least`, on the way down from x = 0.
double reach(double log_g, double least) {
  double low = 0.0;
  double high = 1.0;
  while (log_he_torrance_series(log_g, high) > least) high *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (log_he_torrance_series(log_g, middle) > least ? low : high) = middle;
  }
  return low;
}

// Uniform in ln g; x = 0, small x, and x along the fall of ln W to -690, in strata of its cube root.
Places everywhere(double low, double high, int strata, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Places p;
  for (int i = 0; i < strata; ++i) {
    const double log_g = low + (high - low) * (i + unit(random)) / strata;
    const double top = log_he_torrance_series(log_g, 0.0);
    p.add(log_g, 0.0);
    for (int k = 0; k < 4; ++k) p.add(log_g, 40.0 * unit(random));
    for (int k = 0; k < 12 && top > -680.0; ++k) {
      const double fraction = (k + unit(random)) / 12.0;
      p.add(log_g, reach(log_g, top - (690.0 + top) * fraction * fraction * fraction));
    }
  }
  return p;
}

// Both sides of where neighbours along ln g, and along ln x, are of different regions.
Places borders() {
  Places p;
  const auto number = [](double log_g, double x) {
    const double r = std::exp(-log_g);
    const auto f = he_torrance::fine_region(r, x);
    const auto c = he_torrance::coarse_region(r, x);
    return 1000 * f + 100 * he_torrance::fine_rest(r, x) + 10 * c + he_torrance::coarse_rest(r, x);
  };
  const auto add_border = [&](double g0, double x0, double g1, double x1) {
    const auto first = number(g0, x0);
    if (number(g1, x1) == first) return;
    for (int i = 0; i < 60; ++i) {
      const double g = 0.5 * (g0 + g1);
      const double x = 0.5 * (x0 + x1);
      if (number(g, x) == first) {
        g0 = g, x0 = x;
      } else {
        g1 = g, x1 = x;
      }
    }
    p.add(g0, x0);
    p.add(g1, x1);
  };
  constexpr double step = 0.05;
  for (double log_g = -4.0; log_g < 6.5; log_g += step) {
    for (double log_x = -1.0; log_x < 11.0; log_x += step) {
      const double x = std::exp(log_x);
      add_border(log_g, x, log_g + step, x);
      add_border(log_g, x, log_g, x * std::exp(step));
    }
  }
  return p;
}

// The largest error where ln W > `least`, over `scale` 1 or, of float, 1 + |ln W|; elsewhere the value must be as low.
template <class Real>
double worst_error(const std::string& what, const Places& p, const std::vector<double>& want,
                   const std::vector<Real>& got, double least, bool relative = false) {
  double worst = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto value = static_cast<double>(got[i]);
    if (want[i] <= least) {
      EXPECT_LE(value, least + 1e-3) << p.log_g[i] << " " << p.x[i];
      continue;
    }
    const double error = std::fabs(value - want[i]) / (relative ? 1.0 + std::fabs(want[i]) : 1.0);
    if (!(error <= worst)) {
      worst = std::isnan(error) ? HUGE_VAL : error;
      at = i;
    }
  }
  std::printf("  %-32s %7zu places, max %.2g at ln g %.6g, x %.6g\n", what.c_str(), p.size(), worst, p.log_g[at],
              p.x[at]);
  return worst;
}

void expect_right(const std::string& name, const Places& p) {
  const std::vector<double> want = p.series();
  for (const InstructionSet s : available()) {
    for (const HeTorranceAccuracy a : {fine, coarse}) {
      const std::string what = name + (a == fine ? ", fine, " : ", coarse, ") + std::string(name_of(s));
      EXPECT_LT(worst_error(what, p, want, p.block(a, s), -690.0), tolerance_of(a));
    }
  }
}

TEST(HeTorranceBlock, MeetsTheSeriesEverywhere) {
  expect_right("ln g -27 to -2", everywhere(-27.0, -2.0, 500, 1));
  expect_right("ln g -2 to 3.6", everywhere(-2.0, 3.6, 1500, 2));
  expect_right("ln g 3.6 to 6.5", everywhere(3.6, 6.5, 600, 3));
  expect_right("ln g 6.5 to 11", everywhere(6.5, 11.0, 60, 4));
}

// Beyond ln g = 11 the series takes long, but what it turns to, the saddle point, holds.
TEST(HeTorranceBlock, MeetsTheSaddlePointAtLargeG) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Places p;
  std::vector<double> want;
  for (int i = 0; i < 3000; ++i) {
    const double log_g = 11.0 + 17.0 * unit(random);
    p.add(log_g, std::exp(log_g) * 680.0 * std::pow(unit(random), 3));
    want.push_back(he_torrance::log_w_anywhere<false>(p.log_g.back(), p.x.back()).value);
  }
  for (const InstructionSet s : available()) {
    EXPECT_LT(worst_error("ln g 11 to 28, fine", p, want, p.block(fine, s), -690.0), 1e-9);
    EXPECT_LT(worst_error("ln g 11 to 28, coarse", p, want, p.block(coarse, s), -690.0), 1e-4);
  }
}

TEST(HeTorranceBlock, HasNoStepAtBorders) {
  const Places p = borders();
  ASSERT_GT(p.size(), 1000U);
  expect_right("borders", p);
}

// The same place gives the same value whatever surrounds it: alone, in any mixture and at any offset, but for the tier
// of single values, which takes over where a region has few.
TEST(HeTorranceBlock, DependsOnItsPlaceAlone) {
  Places p = everywhere(-6.0, 9.0, 300, 6);
  std::vector<std::size_t> order(p.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937_64(7));
  Places mixed;
  for (const std::size_t i : order) mixed.add(p.log_g[i], p.x[i]);
  for (const InstructionSet s : available()) {
    for (const HeTorranceAccuracy a : {fine, coarse}) {
      const std::vector<double> w = p.block(a, s);
      const std::vector<double> m = mixed.block(a, s);
      for (std::size_t k = 0; k < order.size(); ++k) {
        if (w[order[k]] <= -690.0) continue;
        EXPECT_NEAR(m[k], w[order[k]], tolerance_of(a)) << mixed.log_g[k] << " " << mixed.x[k];
      }
    }
  }
}

// One region alone, so that a bucket holds the whole block, and every number of places.
TEST(HeTorranceBlock, TakesAnyNumberOfPlaces) {
  const std::vector<double> log_gs{-5.0, 1.0, 2.2, 3.0, 3.8, 6.0};
  for (const InstructionSet s : available()) {
    for (const double log_g : log_gs) {
      for (const double x : {1.0, 60.0, 900.0}) {
        const double want = log_he_torrance_series(log_g, x);
        for (const std::size_t n : {0, 1, 2, 3, 7, 8, 9, 17, 255, 256, 257, 600}) {
          const std::vector<double> lg(n, log_g);
          const std::vector<double> xs(n, x);
          std::vector<double> w(n + 1, 42.0);
          log_he_torrance_block(lg.data(), xs.data(), n, w.data(), fine, s);
          for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(w[i], want, 1e-9) << log_g << " " << x << " " << n;
          ASSERT_EQ(w[n], 42.0);
        }
      }
    }
  }
}

TEST(HeTorranceBlock, SinglePrecisionIsWithin1e5) {
  Places p = everywhere(-9.0, 9.0, 1200, 8);
  for (std::size_t i = 0; i < p.size(); ++i) {  // compared at what a float holds
    p.log_g[i] = static_cast<double>(static_cast<float>(p.log_g[i]));
    p.x[i] = static_cast<double>(static_cast<float>(p.x[i]));
  }
  const std::vector<float> log_g(p.log_g.begin(), p.log_g.end());
  const std::vector<float> x(p.x.begin(), p.x.end());
  const std::vector<double> want = p.series();
  for (const InstructionSet s : available()) {
    std::vector<float> w(p.size());
    log_he_torrance_block(log_g.data(), x.data(), w.size(), w.data(), s);
    EXPECT_LT(worst_error("float, " + std::string(name_of(s)), p, want, w, -80.0, true), 1e-5);
  }
}

TEST(HeTorranceBlock, IsNeverNan) {
  Places p;
  for (const double log_g : {-690.0, -100.0, -30.0, -2.0, 0.0, 2.5, 3.6, 4.3, 9.0, 28.0, 300.0, 690.0}) {
    for (const double x : {0.0, 5e-324, 1e-300, 1.0, 24.9, 700.0, 1e4, 1e6, 1e9, 1e15, 1e100, 1e300}) p.add(log_g, x);
  }
  for (const InstructionSet s : available()) {
    for (const HeTorranceAccuracy a : {fine, coarse}) {
      const std::vector<double> w = p.block(a, s);
      for (std::size_t i = 0; i < p.size(); ++i) {
        const double want = he_torrance::log_w_anywhere<false>(p.log_g[i], p.x[i]).value;
        if (want > -690.0) {
          EXPECT_NEAR(w[i], want, tolerance_of(a)) << p.log_g[i] << " " << p.x[i];
        } else {
          EXPECT_LE(w[i], -690.0 + 1e-3) << p.log_g[i] << " " << p.x[i];
        }
      }
    }
  }
}

}  // namespace
}  // namespace goniofit
