#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "geometry/angles.h"
#include "terms/shadowing.h"
#include "terms/slope_distribution.h"
#include "terms/student_t_shadowing.h"
#include "terms/term_errors.h"

namespace goniofit {
namespace {

using namespace term_errors;
using Dual = ceres::Jet<double, 2>;  // of (slope or y, tail)

const std::vector<double> tails{1.0 + 1e-6, 1.1, 1.5, 2.0, 3.0, 12.9, 13.1, 100.0, 1e4, 1e8, 1e12};

// ln of (1 + y/(γ-1))^-γ, with 50 digits to spare for the logarithm near 1.
Big exponent(const Big& y, const Big& tail) { return -tail * log1p(Big(y / (tail - 1))); }

TEST(StudentT, LobeIsItsDefinitionForEveryTailAndArgument) {
  Errors value, by_y, by_tail;
  for (const double tail : tails) {
    for (double ln_y = -690.0; ln_y <= 690.0; ln_y += std::fabs(ln_y) < 30.0 ? 0.7 : 17.0) {
      const double y = std::exp(ln_y);
      const std::string where = place("y %.3g, tail %.7g", y, tail);
      value.add(relative_error(student_t_exponent(y, tail), exponent(Big(y), Big(tail))), where);
      value.add_naive(relative_error(-tail * std::log(1.0 + y / (tail - 1.0)), exponent(Big(y), Big(tail))), where);
      const Dual dual = student_t_exponent(Dual(y, 0), Dual(tail, 1));
      const Big n = Big(tail) - 1;
      const Big slope_y = -Big(tail) / (n + y);
      // -ln(1+x) + (1 + 1/n) x/(1+x), x = y/n; crosses 0 near x = 2/n, so the error is taken relative to its larger
      // part.
      const Big x = Big(y) / n;
      const Big slope_tail = -log1p(x) + (1 + 1 / n) * x / (1 + x);
      const Big scale = std::max(Big(abs(slope_tail)), Big(x / n / (1 + x)));
      by_y.add(relative_error(dual.v[0], slope_y), where);
      if (scale < Big("1e-300")) continue;  // underflows
      by_tail.add(std::fabs(static_cast<double>((dual.v[1] - slope_tail) / scale)), where);
      const Dual plain = -Dual(tail, 1) * log(1.0 + Dual(y, 0) / (Dual(tail, 1) - 1.0));
      by_tail.add_naive(std::fabs(static_cast<double>((plain.v[1] - slope_tail) / scale)), where);
    }
    EXPECT_EQ(student_t_exponent(0.0, tail), 0.0);
    EXPECT_EQ(student_t_exponent(HUGE_VAL, tail), -HUGE_VAL);
  }
  value.print("ln of the student-t lobe");
  by_y.print("its derivative by y");
  by_tail.print("its derivative by the tail");
  EXPECT_LT(value.worst(), 2e-15);
  EXPECT_LT(by_y.worst(), 1e-14);
  EXPECT_LT(by_tail.worst(), 1e-13);
  EXPECT_GT(by_tail.naive(), 1e-3);
}

TEST(StudentT, IsGgxAtTwoAndBeckmannAtInfinity) {
  for (const double slope : {0.02, 0.17, 0.6}) {
    for (const double theta_r : {-40.0, 0.0, 25.0, 30.0, 60.0, 89.0}) {
      const Pair p = make_pair(in_plane(30.0, theta_r));
      const double alpha2 = 4.0 * slope * slope;
      const double cos2 = 1.0 / (1.0 + p.tan2_b);
      const double spread = cos2 * (alpha2 - 1.0) + 1.0;
      const double ggx = alpha2 / (pi * spread * spread);
      const double y = p.tan2_b / alpha2;
      const double d = slope_independent_factor(p) * std::exp(student_t_exponent(y, 2.0)) / (slope * slope);
      EXPECT_NEAR(d / (0.25 * pi * ggx), 1.0, 1e-12);
      EXPECT_NEAR(student_t_exponent(y, 1e15), -y, 1e-12 * y);
    }
  }
}

// One random slope in units of α: density ∝ (n + p²)^(½-γ), integrated as it stands.
class Marginal {
 public:
  explicit Marginal(const Big& tail) : n_(tail - 1), power_(Big(1) / 2 - tail) {
    norm_ = 2 * beyond(Big(0), [](const Big&) { return Big(1); });
  }
  // (1 - Q)/(1 + Λ) with Q = P(p > mu), Λ = E[(p - mu)₊]/mu.
  Big shadowing(const Big& mu) const {
    const Big q = beyond(mu, [](const Big&) { return Big(1); }) / norm_;
    const Big lambda = beyond(mu, [](const Big& above) { return above; }) / norm_ / mu;
    return (1 - q) / (1 + lambda);
  }
  // The same by E[(p - mu)₊] = ∫_mu p dP - mu Q, the first part in closed form: down to tails at which its integral
  // needs a range beyond any quadrature.
  Big shadowing_near_three_halves(const Big& mu) const {
    const Big q = beyond(mu, [](const Big&) { return Big(1); }) / norm_;
    const Big first = n_ / (2 * n_ - 1) * exp((power_ + 1) * log1p(Big(mu * mu / n_))) / norm_;
    return (1 - q) / (1 + first / mu - q);
  }

 private:
  template <class F>
  Big beyond(const Big& mu, const F& weight) const {
    return rule().integrate(
        [&](const Big& above) {
          const Big p = mu + above;
          return Big(weight(above) * exp(power_ * log1p(Big(p * p / n_))));
        },
        Big("1e-22"));
  }
  static boost::math::quadrature::exp_sinh<Big>& rule() {
    static boost::math::quadrature::exp_sinh<Big> r;
    return r;
  }
  Big n_, power_, norm_;
};

Big cotangent(const Zenith& z) { return Big(z.c) / sqrt(Big(z.one_minus_c) * (1 + Big(z.c))); }

TEST(StudentTShadowing, IsItsDefinition) {
  Errors value;
  for (const double tail : {1.7, 2.5, 4.0, 73.1, 1e3}) {
    const Marginal marginal{Big(tail)};
    for (const double theta : {1e-3, 0.3, 1.0, 1.45, 1.57}) {
      const Zenith z = at_angle(theta, false);
      for (const double slope : {0.01, 0.2, 2.0}) {
        const Big truth = marginal.shadowing(cotangent(z) / (2 * Big(slope))) / z.c;
        value.add(relative_error(shadowing_student_t_over_cosine(slope, tail, z.c, z.s()), truth),
                  place("tail %g, theta %g, slope %g", tail, theta, slope));
      }
    }
  }
  value.print("S1/c, student-t smith");
  EXPECT_LT(value.worst(), 1e-12);
}

TEST(StudentTShadowing, IsItsDefinitionCloseToTheSmallestTail) {
  Errors value, lower;
  for (const double tail : {1.5 + 1e-6, 1.501, 1.52, 1.6, 2.2, 13.5}) {
    const Marginal marginal{Big(tail)};
    for (const double ln_mu :
         {-20.0, -4.0, -2.0, -1.0, 0.0, 1.0, 1.5, 2.0, 3.0, 4.5, 6.0, 9.0, 12.0, 15.0, 18.0, 30.0}) {
      // cot = exp(ln_mu) α at slope ½, so that α = 1.
      const double s = 1.0 / std::hypot(1.0, std::exp(ln_mu));
      const double c = std::exp(ln_mu) * s;
      const Big truth = marginal.shadowing_near_three_halves(Big(c) / Big(s)) / c;
      (tail < 2.0 ? lower : value)
          .add(relative_error(shadowing_student_t_over_cosine(0.5, tail, c, s), truth),
               place("tail %.7g, ln μ/α %g", tail, ln_mu));
    }
  }
  lower.print("S1/c, student-t smith, tails 1.5 to 2");
  value.print("S1/c, student-t smith, tails above");
  EXPECT_LT(lower.worst(), 1e-10);
  EXPECT_LT(value.worst(), 1e-12);
}

TEST(StudentTShadowing, DerivativesAreThoseOfItsDefinition) {
  Errors by_slope, by_tail;
  for (const double tail : {1.8, 3.0, 40.0}) {
    const double h = 1e-8;  // truncation 1e-16; the quadrature's 1e-22 becomes 1e-14
    const Marginal here{Big(tail)}, more{Big(tail) * (1 + Big(h))}, less{Big(tail) * (1 - Big(h))};
    for (const double theta : {0.3, 1.0, 1.5}) {
      const Zenith z = at_angle(theta, false);
      const Big mu = cotangent(z);
      for (const double slope : {0.1, 1.0}) {
        const Dual got = shadowing_student_t_over_cosine(Dual(slope, 0), Dual(tail, 1), z.c, z.s());
        const std::string where = place("tail %g, theta %g, slope %g", tail, theta, slope);
        const Big u = mu / (2 * Big(slope));
        const Big slope_truth =
            (here.shadowing(u / (1 + Big(h))) - here.shadowing(u / (1 - Big(h)))) / (2 * Big(h) * slope * z.c);
        const Big tail_truth = (more.shadowing(u) - less.shadowing(u)) / (2 * Big(h) * tail * z.c);
        // Where S1 is nearly 1, a derivative below 1e-5 counts as that much: the quadrature has no more digits.
        const double least = 1e-5 * got.a;
        by_slope.add(
            std::fabs(static_cast<double>((got.v[0] - slope_truth) / std::max(Big(abs(slope_truth)), Big(least)))),
            where);
        by_tail.add(
            std::fabs(static_cast<double>((got.v[1] - tail_truth) / std::max(Big(abs(tail_truth)), Big(least)))),
            where);
      }
    }
  }
  by_slope.print("d(S1/c)/d slope, student-t smith");
  by_tail.print("d(S1/c)/d tail, student-t smith");
  EXPECT_LT(by_slope.worst(), 1e-9);
  EXPECT_LT(by_tail.worst(), 1e-9);
}

TEST(StudentTShadowing, AtTwoIsGgxTimesItsLitHalf) {
  // γ = 2: Λ = (√(1 + α² tan²) - 1)/2 and P(p < μ) = ½ + μ/(2 √(α² + μ²)).
  for (const Zenith& z : zeniths(32)) {
    for (const double slope : slopes) {
      if (z.s() == 0.0) continue;
      const Big mu = cotangent(z);
      const Big alpha = 2 * Big(slope);
      const Big lit = (1 + mu / sqrt(alpha * alpha + mu * mu)) / 2;
      const Big truth = lit / ((1 + sqrt(1 + alpha * alpha / (mu * mu))) / 2) / z.c;
      EXPECT_LT(relative_error(shadowing_student_t_over_cosine(slope, 2.0, z.c, z.s()), truth), 1e-12)
          << z.c << " " << slope;
    }
  }
}

TEST(StudentTShadowing, BecomesGaussianAndVanishesAtThreeHalves) {
  for (const Zenith& z : zeniths(32)) {
    for (const double slope : slopes) {
      const double gaussian = shadowing_smith_over_cosine(slope, z.c, z.s());
      EXPECT_NEAR(shadowing_student_t_over_cosine(slope, 1e15, z.c, z.s()) / gaussian, 1.0, 1e-13) << z.c << slope;
      EXPECT_EQ(shadowing_student_t_over_cosine(slope, smallest_tail_with_smith, z.c, z.s()), 0.0);
      EXPECT_EQ(shadowing_student_t_over_cosine(slope, 1.2, z.c, z.s()), 0.0);
    }
  }
  // Linear in the tail from there on.
  const double once = shadowing_student_t_over_cosine(0.3, 1.5 + 1e-9, 0.4, sine(0.4, 0.6));
  const double twice = shadowing_student_t_over_cosine(0.3, 1.5 + 2e-9, 0.4, sine(0.4, 0.6));
  EXPECT_NEAR(twice / once, 2.0, 1e-6);
  const Dual at_end = shadowing_student_t_over_cosine(Dual(0.3, 0), Dual(1.5, 1), 0.4, sine(0.4, 0.6));
  EXPECT_NEAR(at_end.v[1] * 1e-9 / once, 1.0, 1e-6);
}

TEST(StudentTShadowing, IsFiniteAndSmoothInEveryCorner) {
  double largest_jump = 0.0;
  for (const Zenith& z : zeniths(16)) {
    for (const double slope : slopes) {
      for (const double tail : {1.5, 1.5 + 1e-12, 1.6, 2.0, 13.0, 73.0, 100.0, 1e6, 1e12}) {
        const Dual s = shadowing_student_t_over_cosine(Dual(slope, 0), Dual(tail, 1), z.c, z.s());
        ASSERT_TRUE(std::isfinite(s.a) && std::isfinite(s.v[0]) && std::isfinite(s.v[1]))
            << z.c << " " << slope << " " << tail;
        EXPECT_GE(s.a, 0.0);
        EXPECT_LE(s.a * z.c, 1.0 + 1e-15);
        // Across the places where a form changes, the value goes on along its own derivative.
        const double step = 1e-9 * tail;
        const double below = shadowing_student_t_over_cosine(slope, tail - step, z.c, z.s());
        const double above = shadowing_student_t_over_cosine(slope, tail + step, z.c, z.s());
        if (tail > 1.6) {
          largest_jump = std::max(largest_jump, std::fabs((above - below - 2.0 * step * s.v[1]) / s.a));
        }
      }
      if (z.s() == 0.0) {
        EXPECT_EQ(shadowing_student_t_over_cosine(slope, 2.5, z.c, z.s()), 1.0);
      }
    }
  }
  std::printf("  largest jump of S1/c across a tail: %.2g\n", largest_jump);
  EXPECT_LT(largest_jump, 1e-13);
}

TEST(StudentTShadowing, RuleAndGammaRatioAreWhatTheySayTheyAre) {
  using Rule = boost::math::quadrature::gauss<Big, 24>;
  for (std::size_t k = 0; k < student_t::nodes.size(); ++k) {
    EXPECT_EQ(student_t::nodes[k], static_cast<double>(Rule::abscissa()[k]));
    EXPECT_EQ(student_t::weights[k], static_cast<double>(Rule::weights()[k]));
  }
  Errors errors;
  for (const double n : {1e-3, 0.5, 0.75, 1.0, 3.3, 11.9, 12.0, 12.1, 50.0, 1e3, 1e6})
    errors.add(relative_error(student_t::gamma_ratio(n),
                              boost::math::tgamma_ratio(Big(n) + Big(1) / 2, Big(n)) / sqrt(Big(n))),
               place("n %g", n));
  errors.print("Γ(n + ½)/(Γ(n) √n)");
  EXPECT_LT(errors.worst(), 1e-15);
}

}  // namespace
}  // namespace goniofit
