#include "terms/oren_nayar.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/angles.h"
#include "support/paths.h"

namespace goniofit {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

const std::vector<AnglePair> corners{
    {0.0, 0.0, 0.0, 0.0},         {0.0, 0.0, 50.0, 30.0},           {1e-9, 0.0, 40.0, 100.0},
    {1e-9, 0.0, 1e-9, 180.0},     {30.0, 10.0, 30.0, 10.0},         {60.0, 0.0, 60.0, 180.0},
    {60.0, 0.0, 45.0, 90.0},      {75.0, 20.0, 80.0, 155.0},        {89.9999, 0.0, 20.0, 170.0},
    {89.9999, 0.0, 89.9999, 0.0}, {89.9999, 0.0, 89.9999, 90.0},    {89.9999, 0.0, 89.9999, 180.0},
    {89.9999, 0.0, 89.99, 180.0}, {89.9999, 0.0, 89.9998, 179.9999}};

// The printed forms, (14), (15) and the mended (17), from angles at 50 digits: none of the rearrangements.
struct Printed {
  Big direct, interreflection, qualitative;
};
Printed printed(const Big& s, const AnglePair& a) {
  const Big right_angle = asin(Big(1));
  const Big degree = right_angle / 90;
  const Big alpha = degree * Big(std::max(a.theta_i_deg, a.theta_r_deg));
  const Big beta = degree * Big(std::min(a.theta_i_deg, a.theta_r_deg));
  const Big cosine = cos(degree * (Big(a.phi_r_deg) - Big(a.phi_i_deg)));
  const Big s2 = s * s;
  const Big x = beta / right_angle;
  const Big part = s2 / (s2 + Big(9) / 100);
  const Big c1 = 1 - s2 / (s2 + Big(33) / 100) / 2;
  const Big c2 = Big(45) / 100 * part * (cosine >= 0 ? Big(sin(alpha)) : Big(sin(alpha) - x * x * x));
  const Big y = alpha * beta / (right_angle * right_angle);
  const Big c3 = part * y * y / 8;
  return {c1 + cosine * c2 * tan(beta) + (1 - abs(cosine)) * c3 * tan((alpha + beta) / 2),
          Big(17) / 100 * s2 / (s2 + Big(13) / 100) * (1 - cosine * x * x),
          c1 + Big(45) / 100 * part * (cosine > 0 ? cosine : Big(0)) * sin(alpha) * tan(beta)};
}

double relative_error(double value, const Big& truth) {
  return std::fabs(static_cast<double>(Big((Big(value) - truth) / truth)));
}

TEST(OrenNayar, DoublesMeetThePrintedFormsAtFiftyDigits) {
  double worst = 0.0;
  double worst_at_cancellation = 0.0;
  for (const double s : {1e-3, 0.1, 0.5, 1.0, 1.4}) {
    for (const AnglePair& a : corners) {
      const Pair p = make_pair(a);
      const oren_nayar::Functional<double> f = oren_nayar::functional(s, p);
      const Printed truth = printed(Big(s), a);
      // Where (14) crosses zero, its terms are what the round-off is relative to.
      double& worst_direct = abs(truth.direct) < Big(0.3) ? worst_at_cancellation : worst;
      worst_direct = std::max(worst_direct, relative_error(f.direct, truth.direct));
      worst = std::max(worst, relative_error(f.interreflection, truth.interreflection));
      worst = std::max(worst, relative_error(oren_nayar::qualitative(s, p), truth.qualitative));
    }
  }
  EXPECT_LT(worst, 2e-15);
  EXPECT_LT(worst_at_cancellation, 1e-14);
}

// The same template at 50 digits on the same geometry: round-off of the formulas alone.
BasicPair<Big> widened(const Pair& p) {
  BasicPair<Big> wide{};
  wide.cos_i = p.cos_i;
  wide.cos_r = p.cos_r;
  wide.one_minus_cos_i = p.one_minus_cos_i;
  wide.one_minus_cos_r = p.one_minus_cos_r;
  wide.s_z = p.s_z;
  wide.s_h2 = p.s_h2;
  wide.cos_h = p.cos_h;
  wide.one_minus_cos_h = p.one_minus_cos_h;
  wide.dot_h = p.dot_h;
  return wide;
}

TEST(OrenNayar, RoundOffOfTheTemplatesStaysBelowThirteenDigits) {
  for (const double s : {1e-3, 0.3, 1.4}) {
    for (const AnglePair& a : corners) {
      const Pair p = make_pair(a);
      const oren_nayar::Functional<double> f = oren_nayar::functional(s, p);
      const oren_nayar::Functional<Big> truth = oren_nayar::functional(Big(s), widened(p));
      // Forward grazing: C1 - C2 tan(beta) cancels down to the value.
      const double scale = 1.0 + 1.0 / std::fabs(static_cast<double>(truth.direct));
      EXPECT_LT(relative_error(f.direct, truth.direct), 1e-13 * scale)
          << s << ' ' << a.theta_i_deg << ' ' << a.phi_r_deg;
      EXPECT_LT(relative_error(f.interreflection, truth.interreflection), 1e-13) << s;
      EXPECT_LT(relative_error(oren_nayar::qualitative(s, p), oren_nayar::qualitative(Big(s), widened(p))), 1e-13) << s;
    }
  }
}

TEST(OrenNayar, IsLambertExactlyAtFacetSlopeZero) {
  for (const AnglePair& a : corners) {
    const oren_nayar::Functional<double> f = oren_nayar::functional(0.0, make_pair(a));
    EXPECT_EQ(f.direct, 1.0);
    EXPECT_EQ(f.interreflection, 0.0);
    EXPECT_EQ(oren_nayar::qualitative(0.0, make_pair(a)), 1.0);
  }
}

TEST(OrenNayar, IsReciprocal) {
  for (const AnglePair& a : corners) {
    const Pair p = make_pair(a);
    const Pair q = make_pair(swapped(a));
    const auto f = oren_nayar::functional(0.6, p);
    const auto g = oren_nayar::functional(0.6, q);
    EXPECT_NEAR(f.direct, g.direct, 1e-13 * std::fabs(f.direct) + 1e-14);
    EXPECT_NEAR(f.interreflection, g.interreflection, 1e-15);
    EXPECT_NEAR(oren_nayar::qualitative(0.6, p) / oren_nayar::qualitative(0.6, q), 1.0, 1e-14);
  }
}

TEST(OrenNayar, RetroIsTheBrightSideAndItsClosedFormHolds) {
  // Both at 45° on the retro side: (17) = A + B sin 45° tan 45°, (14) = C1 + C2 tan 45° with C3 out of play.
  const double s = 0.5;
  const double a = 1.0 - 0.5 * 0.25 / 0.58;
  const double b = 0.45 * 0.25 / 0.34;
  const Pair retro = make_pair(in_plane(45.0, -45.0));
  EXPECT_NEAR(oren_nayar::qualitative(s, retro), a + b * std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(oren_nayar::functional(s, retro).direct, a + b * std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(oren_nayar::functional(s, retro).interreflection, 0.17 * 0.25 / 0.38 * 0.75, 1e-15);
  const Pair mirror = make_pair(in_plane(45.0, 45.0));
  EXPECT_NEAR(oren_nayar::qualitative(s, mirror), a, 1e-15);
  EXPECT_NEAR(oren_nayar::functional(s, mirror).direct, a - b * (std::sqrt(0.5) - 0.125), 1e-15);
  EXPECT_NEAR(oren_nayar::functional(s, mirror).interreflection, 0.17 * 0.25 / 0.38 * 1.25, 1e-15);
}

TEST(OrenNayar, DualsGiveTheDerivativeByFacetSlope) {
  using Dual = ceres::Jet<double, 1>;
  for (const double s : {0.0, 0.05, 0.5, 1.2}) {
    for (const AnglePair& a : {corners[4], corners[5], corners[7], corners[9]}) {
      const Pair p = make_pair(a);
      const auto f = oren_nayar::functional(Dual(s, 0), p);
      const double h = 1e-5;
      const auto above = oren_nayar::functional(s + h, p);
      const auto below = oren_nayar::functional(s - h, p);
      const double scale = 1.0 + std::fabs(f.direct.v[0]);
      EXPECT_NEAR(f.direct.v[0], (above.direct - below.direct) / (2.0 * h), 1e-8 * scale);
      EXPECT_NEAR(f.interreflection.v[0], (above.interreflection - below.interreflection) / (2.0 * h), 1e-8);
      const Dual q = oren_nayar::qualitative(Dual(s, 0), p);
      EXPECT_NEAR(q.v[0], (oren_nayar::qualitative(s + h, p) - oren_nayar::qualitative(s - h, p)) / (2.0 * h),
                  1e-8 * scale);
    }
  }
}

TEST(OrenNayar, IsFiniteForEveryDirectionAboveTheHorizon) {
  for (const double below : {1e-2, 1e-6, 1e-12, 1e-13}) {
    const double theta = 90.0 - below;
    const double cosine = cos_deg(theta);
    for (const double delta : {0.0, 60.0, 90.0, 120.0, 179.0, 180.0}) {
      const Pair p = make_pair({theta, 0.0, theta, delta});
      const auto f = oren_nayar::functional(0.5, p);
      ASSERT_TRUE(std::isfinite(f.direct) && std::isfinite(f.interreflection));
      // Without a bound, but only as 1/cos: the radiance f cos_i stays below 1/pi.
      EXPECT_LT(std::fabs(f.direct) * cosine, 1.0) << below << ' ' << delta;
      EXPECT_LT(oren_nayar::qualitative(0.5, p) * cosine, 1.0);
    }
  }
  const Pair both = make_pair(in_plane(89.9999, -89.9999));
  EXPECT_GT(oren_nayar::functional(0.5, both).direct, 1e5);
}

// (14) is negative in the forward corner from 40° on, and nowhere else.
TEST(OrenNayar, NeedsTheCutAtForwardGrazingFromFortyDegreesOn) {
  const auto count = [](double facet_slope_deg) {
    int cut = 0;
    for (int i = 1; i < 90; ++i) {
      for (int r = 1; r < 90; ++r) {
        for (int delta = 0; delta <= 180; delta += 10) {
          const double direct =
              oren_nayar::functional(
                  radians(facet_slope_deg),
                  make_pair({static_cast<double>(i), 0.0, static_cast<double>(r), static_cast<double>(delta)}))
                  .direct;
          if (!oren_nayar::needs_cut(direct)) {
            EXPECT_EQ(oren_nayar::cut_at_zero(direct), direct);
            continue;
          }
          EXPECT_EQ(oren_nayar::cut_at_zero(direct), 0.0);
          EXPECT_GT(std::min(i, r), 60);
          EXPECT_GT(delta, 130);
          ++cut;
        }
      }
    }
    return cut;
  };
  EXPECT_EQ(count(10.0), 0);
  EXPECT_EQ(count(38.0), 0);
  const int at_40 = count(40.0);
  const int at_60 = count(60.0);
  EXPECT_GT(at_40, 0);
  EXPECT_GT(at_60, at_40);
  RecordProperty("cut_at_40_degrees", at_40);
  RecordProperty("cut_at_60_degrees", at_60);
}

// The albedo at rho = 1, by the midpoint rule in variables that crowd at grazing and at the retro azimuth.
double functional_albedo(double facet_slope, double theta_i_deg) {
  const int zeniths = 200;
  const int azimuths = 60;
  double sum = 0.0;
  for (int a = 0; a < zeniths; ++a) {
    const double x = (a + 0.5) / zeniths;
    const double from_horizon = 90.0 * x * x;
    const double weight = sin_deg(from_horizon) * cos_deg(from_horizon) * pi * x / zeniths;
    for (int b = 0; b < azimuths; ++b) {
      const double y = (b + 0.5) / azimuths;
      const Pair p = make_pair({theta_i_deg, 0.0, 90.0 - from_horizon, 180.0 * y * y * (3.0 - 2.0 * y)});
      const auto f = oren_nayar::functional(facet_slope, p);
      sum += weight * 12.0 * y * (1.0 - y) / azimuths * (oren_nayar::cut_at_zero(f.direct) + f.interreflection);
    }
  }
  return sum;
}

// The fit (14)+(15) is no surface: it gives back up to 5 % more than it gets. The integral does not
// (v_cavity_integral_test).
TEST(OrenNayar, FunctionalFormReflectsUpToFivePercentTooMuch) {
  EXPECT_NEAR(functional_albedo(0.0, 60.0), 1.0, 1e-3);
  EXPECT_NEAR(functional_albedo(radians(15.0), 85.0), 1.030, 0.002);
  double worst = 0.0;
  for (const double slope : {5.0, 10.0, 15.0, 20.0, 30.0, 50.0}) {
    for (const double theta : {0.0, 60.0, 80.0, 88.0, 89.9})
      worst = std::max(worst, functional_albedo(radians(slope), theta));
  }
  EXPECT_GT(worst, 1.045);
  EXPECT_LT(worst, 1.053);
}

// Another library's values of (17), with rho 1, 0.5, 0.25 at facet slopes 0.2, 0.5, 0.9.
TEST(OrenNayar, QualitativeFormMeetsAnotherLibrary) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  std::ifstream file(*test::shared_data() / "peers" / "eval_orennayar.csv");
  const std::vector<std::pair<double, double>> materials{{1.0, 0.2}, {0.5, 0.5}, {0.25, 0.9}};
  std::string line;
  int rows = 0;
  double worst = 0.0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    std::getline(cells, cell, ',');
    std::vector<double> numbers;
    while (std::getline(cells, cell, ',')) numbers.push_back(std::stod(cell));
    ASSERT_EQ(numbers.size(), 7U);
    const Pair p = make_pair({degrees(numbers[0]), degrees(numbers[1]), degrees(numbers[2]), degrees(numbers[3])});
    for (std::size_t k = 0; k < materials.size(); ++k) {
      const double f = materials[k].first / pi * oren_nayar::qualitative(materials[k].second, p);
      worst = std::max(worst, std::fabs(f / numbers[4 + k] - 1.0));
    }
    ++rows;
  }
  EXPECT_EQ(rows, 610);
  EXPECT_LT(worst, 1e-11);
}

}  // namespace
}  // namespace goniofit
