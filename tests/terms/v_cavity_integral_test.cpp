#include "terms/v_cavity_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/angles.h"
#include "terms/oren_nayar.h"
#include "terms/v_cavity.h"

namespace goniofit {
namespace {

// Oren & Nayar (5)-(13) from vectors, with GAF's inner minimum and the widths measured from the groove; nothing of src/
// but the two angles' sines.
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector direction(double theta_deg, double phi_deg) {
  return {sin_deg(theta_deg) * cos_deg(phi_deg), sin_deg(theta_deg) * sin_deg(phi_deg), cos_deg(theta_deg)};
}

FacetReflectance plain_facet(const Vector& s, const Vector& v, double theta_a, double phi_a) {
  const double x = std::sin(theta_a) * std::cos(phi_a);
  const double y = std::sin(theta_a) * std::sin(phi_a);
  const double az = std::cos(theta_a);
  const double sa = dot(s, {x, y, az});
  const double va = dot(v, {x, y, az});
  const double other_sa = dot(s, {-x, -y, az});
  const double normalisation = az * v[2] * s[2];
  FacetReflectance f;
  if (sa > 0.0 && va > 0.0) {
    const double gaf = std::max(0.0, std::min({1.0, 2.0 * s[2] * az / sa, 2.0 * v[2] * az / va}));
    f.direct = sa * va * gaf / normalisation;
  }
  if (other_sa > 0.0 && va > 0.0) {
    const double m_s = 1.0 - std::min(1.0, 2.0 * s[2] * az / other_sa);
    const double m_v = 1.0 - std::min(1.0, 2.0 * v[2] * az / va);
    const double c = std::cos(2.0 * theta_a);
    const auto d = [c](double p, double q) { return std::sqrt(p * p + 2.0 * p * q * c + q * q); };
    f.interreflection = other_sa * va / normalisation * 0.5 * (d(1, m_v) + d(1, m_s) - d(m_s, m_v) - d(1, 1));
  }
  return f;
}

// A million facets by the midpoint rule, normalised by their own sum.
FacetReflectance brute_force(const AnglePair& a, double facet_slope) {
  constexpr int n = 1000;
  const Vector s = direction(a.theta_i_deg, a.phi_i_deg);
  const Vector v = direction(a.theta_r_deg, a.phi_r_deg);
  const double end = std::min(0.5 * pi, 9.0 * facet_slope);
  FacetReflectance total;
  double mass = 0.0;
  for (int i = 0; i < n; ++i) {
    const double theta_a = end * (i + 0.5) / n;
    const double weight = std::exp(-0.5 * theta_a * theta_a / (facet_slope * facet_slope)) * std::sin(theta_a);
    mass += weight * n;
    for (int j = 0; j < n; ++j) {
      const FacetReflectance f = plain_facet(s, v, theta_a, 2.0 * pi * (j + 0.5) / n);
      total.direct += weight * f.direct;
      total.interreflection += weight * f.interreflection;
    }
  }
  return {total.direct / mass, total.interreflection / mass};
}

const std::vector<AnglePair> directions{{0.0, 0.0, 0.0, 0.0},      {30.0, 0.0, 30.0, 0.0},    {30.0, 0.0, 50.0, 180.0},
                                        {60.0, 20.0, 75.0, 130.0}, {60.0, 0.0, 60.0, 180.0},  {80.0, 0.0, 80.0, 0.0},
                                        {89.0, 0.0, 60.0, -30.0},  {85.0, 10.0, 85.0, 190.0}, {45.0, 0.0, 0.0, 77.0}};

TEST(VCavities, MeetAMillionFacetsSummedFromVectors) {
  double worst = 0.0;
  for (const AnglePair& a : directions) {
    for (const double slope_deg : {2.0, 30.0, 80.0}) {
      const double facet_slope = radians(slope_deg);
      const VCavities ours = gaussian_cavities(make_pair(a), facet_slope);
      const FacetReflectance plain = brute_force(a, facet_slope);
      worst = std::max(worst, std::fabs(ours.direct / plain.direct - 1.0));
      worst = std::max(worst, std::fabs(ours.interreflection / plain.interreflection - 1.0));
      EXPECT_LE(ours.error_estimate, 1e-6);
    }
  }
  EXPECT_LT(worst, 4e-5);  // the sum's own error, largest where one direction is at 89°
}

TEST(VCavities, FacetsAreThoseOfTheVectors) {
  for (const AnglePair& a : directions) {
    const double delta = wrap_deg(a.phi_r_deg - a.phi_i_deg);
    const Vector s = direction(a.theta_i_deg, 0.0);
    const Vector v = direction(a.theta_r_deg, std::fabs(delta));
    for (const double theta_a : {0.01, 0.3, 0.9, 1.5}) {
      for (double phi_a = 0.1; phi_a < 6.2; phi_a += 0.3) {
        const FacetReflectance ours = uni_directional_facet(make_pair(a), theta_a, phi_a);
        const FacetReflectance plain = plain_facet(s, v, theta_a, phi_a);
        EXPECT_NEAR(ours.direct, plain.direct, 1e-12 * (1.0 + plain.direct));
        EXPECT_NEAR(ours.interreflection, plain.interreflection, 1e-12);
      }
    }
  }
}

// (12): the mean of the uni-directional facets over their azimuth, by the midpoint rule, which the kinks leave at 1e-5.
TEST(VCavities, IsotropicSurfaceIsTheMeanOfItsFacets) {
  for (const AnglePair a : {in_plane(30.0, -50.0), in_plane(60.0, 70.0), AnglePair{45.0, 10.0, 65.0, 100.0}}) {
    const Pair p = make_pair(a);
    for (const double theta_a : {0.05, 0.4, 1.0}) {
      constexpr int facets = 20000;
      double direct = 0.0;
      double interreflection = 0.0;
      for (int i = 0; i < facets; ++i) {
        const FacetReflectance f = uni_directional_facet(p, theta_a, 2.0 * pi * (i + 0.5) / facets);
        direct += f.direct / facets;
        interreflection += f.interreflection / facets;
      }
      const FacetReflectance mean = isotropic_single_slope(p, theta_a);
      EXPECT_NEAR(mean.direct, direct, 1e-5 * (1.0 + direct)) << theta_a;
      EXPECT_NEAR(mean.interreflection, interreflection, 1e-5) << theta_a;
    }
  }
}

TEST(VCavities, AttenuationIsShadowingAndMaskingWhicheverIsMore) {
  EXPECT_EQ(geometric_attenuation(1.0, 1.0), 1.0);
  EXPECT_EQ(geometric_attenuation(2.0, 2.0), 1.0);
  EXPECT_EQ(geometric_attenuation(4.0, 1.0), 0.5);
  EXPECT_EQ(geometric_attenuation(4.0, 8.0), 0.25);
  EXPECT_EQ(geometric_attenuation(-0.1, 1.0), 0.0);
  EXPECT_EQ(geometric_attenuation(1.0, 0.0), 0.0);
  // Retro, facet towards both: its visible part is its lit part, direct = cos a · A² · min(1, 2/A).
  const Pair retro = make_pair(in_plane(70.0, -70.0));
  for (const double theta_a : {0.1, 0.3, 0.5, 1.2}) {
    const double a = 1.0 + std::tan(theta_a) * std::tan(radians(70.0));
    EXPECT_NEAR(uni_directional_facet(retro, theta_a, 0.0).direct, std::cos(theta_a) * a * std::min(a, 2.0), 1e-12);
  }
}

// (9): the kernel (7) integrated over the two exposed widths, by the midpoint rule.
TEST(VCavities, InterreflectionFactorIsTheIntegralOfItsKernel) {
  for (const double theta_a : {0.2, 0.7, 1.3}) {
    for (const double lit : {1.0, 0.6, 0.01}) {
      for (const double seen : {1.0, 0.4, 0.01}) {
        constexpr int n = 400;
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            const double x = 1.0 - seen * (i + 0.5) / n;
            const double y = 1.0 - lit * (j + 0.5) / n;
            const double sine = std::sin(2.0 * theta_a);
            const double d2 = x * x + 2.0 * x * y * std::cos(2.0 * theta_a) + y * y;
            sum += 0.5 * sine * sine * x * y / (d2 * std::sqrt(d2));
          }
        }
        // The kernel of whole grooves is singular at the bottom, where the rule is not good.
        const double rule = lit == 1.0 && seen == 1.0 ? 4e-3 : 2e-5;
        EXPECT_NEAR(interreflection_density(std::cos(theta_a), lit, seen) / (sum / (n * n)), 1.0, rule) << lit << seen;
      }
    }
  }
  // The whole groove: 1 - sin(half its angle) = 1 - cos(theta_a).
  EXPECT_NEAR(interreflection_density(0.5, 1.0, 1.0), 0.5, 1e-15);
  // Hardly exposed: the kernel at x = y = 1, where the four distances meet.
  const double kernel = 0.5 * std::pow(std::sin(1.4), 2) / std::pow(2.0 + 2.0 * std::cos(1.4), 1.5);
  EXPECT_NEAR(interreflection_density(std::cos(0.7), 1e-9, 1e-9) / kernel, 1.0, 1e-8);
}

// At L = V = N a facet's direct part is cos(theta_a): closed form in the facet alone, so this is the density's test.
TEST(VCavities, FacetSlopesAreNormalisedOverSolidAngle) {
  const Pair normal = make_pair({0.0, 0.0, 0.0, 0.0});
  for (const double facet_slope : {1e-3, 0.1, 0.5, 1.4, 100.0}) {
    constexpr int n = 200000;
    const double end = std::min(0.5 * pi, 12.0 * facet_slope);
    double mass = 0.0;
    double lost = 0.0;
    double hidden = 0.0;
    for (int i = 0; i < n; ++i) {
      const double theta = end * (i + 0.5) / n;
      const double p = std::exp(-0.5 * theta * theta / (facet_slope * facet_slope)) * std::sin(theta);
      const double one_minus_cos = 2.0 * std::pow(std::sin(0.5 * theta), 2);
      mass += p;
      lost += p * one_minus_cos;
      hidden += p * one_minus_cos * std::cos(theta);
    }
    const VCavities f = gaussian_cavities(normal, facet_slope, 1e-9);
    EXPECT_NEAR((1.0 - f.direct) / (lost / mass), 1.0, 3e-10);  // the rule's own error
    EXPECT_NEAR(f.interreflection / (hidden / mass), 1.0, 3e-10);
  }
  // Flat in theta_a: the means of cos and of cos (1 - cos) over the hemisphere.
  EXPECT_NEAR(gaussian_cavities(normal, 1e6).direct, 0.5, 1e-9);
  EXPECT_NEAR(gaussian_cavities(normal, 1e6).interreflection, 1.0 / 6.0, 1e-9);
}

TEST(VCavities, AreLambertAtFacetSlopeZeroAndNearlySoBeside) {
  for (const AnglePair& a : directions) {
    const VCavities none = gaussian_cavities(make_pair(a), 0.0);
    EXPECT_EQ(none.direct, 1.0);
    EXPECT_EQ(none.interreflection, 0.0);
    // To second order: <theta²> = 2 s² of (tan tan cos(delta) - 1)/2, and interreflection <theta²>/2.
    const double s = 1e-4;
    const double tilt =
        std::tan(radians(a.theta_i_deg)) * std::tan(radians(a.theta_r_deg)) * cos_deg(a.phi_r_deg - a.phi_i_deg);
    const VCavities slight = gaussian_cavities(make_pair(a), s);
    EXPECT_NEAR(slight.direct - 1.0, s * s * (tilt - 1.0), 1e-13);
    EXPECT_NEAR(slight.direct_by_facet_slope, 2.0 * s * (tilt - 1.0), 1e-9 * std::fabs(tilt) + 1e-11);
    EXPECT_NEAR(slight.interreflection / (s * s), 1.0, 1e-5);
    EXPECT_NEAR(slight.interreflection_by_facet_slope / (2.0 * s), 1.0, 1e-5);
  }
}

TEST(VCavities, AreReciprocal) {
  for (const AnglePair& a : directions) {
    for (const double facet_slope : {0.1, 0.8}) {
      const VCavities f = gaussian_cavities(make_pair(a), facet_slope, 1e-9);
      const VCavities g = gaussian_cavities(make_pair(swapped(a)), facet_slope, 1e-9);
      EXPECT_NEAR(f.direct / g.direct, 1.0, 1e-9);
      EXPECT_NEAR(f.interreflection / g.interreflection, 1.0, 1e-9);
    }
  }
}

TEST(VCavities, DerivativesAreThoseOfTheValues) {
  for (const AnglePair& a : directions) {
    for (const double s : {0.05, 0.5, 1.2}) {
      const Pair p = make_pair(a);
      const double h = 1e-4 * s;
      const VCavities f = gaussian_cavities(p, s, 1e-9);
      const VCavities above = gaussian_cavities(p, s + h, 1e-9);
      const VCavities below = gaussian_cavities(p, s - h, 1e-9);
      EXPECT_NEAR(f.direct_by_facet_slope, (above.direct - below.direct) / (2.0 * h), 1e-6);
      EXPECT_NEAR(f.interreflection_by_facet_slope, (above.interreflection - below.interreflection) / (2.0 * h), 1e-6);
    }
  }
}

TEST(VCavities, StayAccurateTowardsGrazingAtEveryFacetSlope) {
  for (const double theta_r : {1e-7, 30.0, 89.9, 89.9999}) {
    for (const double delta : {0.0, 1e-3, 90.0, 179.0, 180.0}) {
      const Pair p = make_pair({89.9999, 0.0, theta_r, delta});
      for (const double facet_slope : {1e-3, 0.1, radians(80.0)}) {
        const VCavities rough = gaussian_cavities(p, facet_slope, 1e-5);
        const VCavities fine = gaussian_cavities(p, facet_slope, 1e-7);
        EXPECT_LE(rough.error_estimate, 1e-5) << theta_r << ' ' << delta << ' ' << facet_slope;
        EXPECT_LE(fine.error_estimate, 1e-7) << theta_r << ' ' << delta << ' ' << facet_slope;
        EXPECT_NEAR(rough.direct / fine.direct, 1.0, 1e-5) << theta_r << ' ' << delta << ' ' << facet_slope;
        EXPECT_NEAR(rough.interreflection / fine.interreflection, 1.0, 1e-5);
        EXPECT_GT(fine.direct, 0.0);
        EXPECT_GE(fine.interreflection, 0.0);
      }
    }
  }
  const VCavities outside = gaussian_cavities(make_pair({90.0, 0.0, 90.5, 0.0}), 0.5);
  EXPECT_EQ(outside.direct, 0.0);
  EXPECT_EQ(outside.interreflection, 0.0);
}

TEST(VCavities, TableServesEveryFacetSlopeOfItsRange) {
  for (const AnglePair& a : directions) {
    const Pair p = make_pair(a);
    const VCavityTable table(p, radians(1.0), radians(80.0), 1e-6);
    for (const double slope_deg : {1.0, 1.3, 2.9, 7.0, 15.0, 33.0, 57.0, 80.0}) {
      const VCavities fast = table.at(radians(slope_deg));
      const VCavities slow = gaussian_cavities(p, radians(slope_deg), 1e-9);
      EXPECT_NEAR(fast.direct / slow.direct, 1.0, 1e-8);
      EXPECT_NEAR(fast.interreflection / slow.interreflection, 1.0, 1e-8);
      EXPECT_NEAR(fast.direct_by_facet_slope, slow.direct_by_facet_slope, 1e-7);
      EXPECT_NEAR(fast.interreflection_by_facet_slope, slow.interreflection_by_facet_slope, 1e-7);
    }
    EXPECT_EQ(table.at(radians(0.5)).direct, gaussian_cavities(p, radians(0.5), 1e-6).direct);
    EXPECT_EQ(table.at(radians(85.0)).direct, gaussian_cavities(p, radians(85.0), 1e-6).direct);
  }
}

// rho = 1, two bounces: a surface that gives back no more than it gets. Midpoint rule crowding at grazing and retro.
TEST(VCavities, ReflectAtMostWhatTheyReceive) {
  const auto albedo = [](double facet_slope, double theta_i_deg) {
    const int zeniths = 60;
    const int azimuths = 30;
    double sum = 0.0;
    for (int a = 0; a < zeniths; ++a) {
      const double x = (a + 0.5) / zeniths;
      const double from_horizon = 90.0 * x * x;
      const double weight = sin_deg(from_horizon) * cos_deg(from_horizon) * pi * x / zeniths;
      for (int b = 0; b < azimuths; ++b) {
        const double y = (b + 0.5) / azimuths;
        const VCavities f = gaussian_cavities(
            make_pair({theta_i_deg, 0.0, 90.0 - from_horizon, 180.0 * y * y * (3.0 - 2.0 * y)}), facet_slope, 1e-3);
        sum += weight * 12.0 * y * (1.0 - y) / azimuths * (f.direct + f.interreflection);
      }
    }
    return sum;
  };
  EXPECT_NEAR(albedo(radians(5.0), 85.0), 1.0, 1e-3);
  EXPECT_NEAR(albedo(radians(15.0), 85.0), 0.9947, 1e-3);
  EXPECT_NEAR(albedo(radians(30.0), 60.0), 0.9263, 1e-3);
}

struct Spread {
  double least = 1e300, largest = -1e300, mean_absolute = 0.0;
};

// How far (14), (15) and (17) are off the integral's direct part, its interreflection, and both at rho = 1; relative,
// with angles up to the limit in steps of 5°.
std::array<Spread, 3> form_errors(double facet_slope, double limit_deg) {
  std::array<Spread, 3> spreads;
  int n = 0;
  for (double i = 0.0; i <= limit_deg; i += 5.0) {
    for (double r = 0.0; r <= i; r += 5.0) {
      for (double delta = 0.0; delta <= 180.0; delta += 15.0, ++n) {
        const Pair p = make_pair({i, 0.0, r, delta});
        const VCavities integral = gaussian_cavities(p, facet_slope, 1e-4);
        const auto form = oren_nayar::functional(facet_slope, p);
        const std::array<double, 3> errors{
            form.direct / integral.direct - 1.0, form.interreflection / integral.interreflection - 1.0,
            oren_nayar::qualitative(facet_slope, p) / (integral.direct + integral.interreflection) - 1.0};
        for (std::size_t k = 0; k < 3; ++k) {
          spreads[k].least = std::min(spreads[k].least, errors[k]);
          spreads[k].largest = std::max(spreads[k].largest, errors[k]);
          spreads[k].mean_absolute += std::fabs(errors[k]);
        }
      }
    }
  }
  for (Spread& spread : spreads) spread.mean_absolute /= n;
  return spreads;
}

TEST(VCavities, AreApproximatedByTheClosedFormsAsFarAsTheirHeaderSays) {
  const auto [direct, interreflection, qualitative] = form_errors(radians(30.0), 60.0);
  EXPECT_NEAR(direct.largest, 0.049, 0.001);
  EXPECT_GT(direct.least, -0.049);
  EXPECT_NEAR(direct.mean_absolute, 0.005, 0.001);
  EXPECT_NEAR(interreflection.least, -0.292, 0.002);
  EXPECT_NEAR(interreflection.largest, 0.486, 0.002);
  EXPECT_NEAR(interreflection.mean_absolute, 0.141, 0.002);
  EXPECT_NEAR(std::max(-qualitative.least, qualitative.largest), 0.187, 0.002);
  const auto [direct_85, interreflection_85, qualitative_85] = form_errors(radians(30.0), 85.0);
  EXPECT_NEAR(direct_85.largest, 1.31, 0.01);  // forward, both at 85°: 0.178 instead of 0.077
  EXPECT_NEAR(direct_85.mean_absolute, 0.013, 0.001);
  EXPECT_NEAR(interreflection_85.mean_absolute, 0.178, 0.002);
  EXPECT_NEAR(qualitative_85.largest, 1.72, 0.01);
}

}  // namespace
}  // namespace goniofit
