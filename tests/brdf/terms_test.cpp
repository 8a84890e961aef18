#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "brdf/surface_shape.h"
#include "geometry/angles.h"

namespace goniofit {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

TEST(SlopeDistribution, IsBeckmannInLiTorrancesNormalisation) {
  for (const double slope : {0.02, 0.17, 0.6}) {
    for (const double theta_r : {-40.0, 0.0, 25.0, 30.0, 60.0}) {
      const Pair p = make_pair(in_plane(30.0, theta_r));
      const double alpha2 = 4.0 * slope * slope;
      const double cos4 = 1.0 / ((1.0 + p.tan2_b) * (1.0 + p.tan2_b));
      const double beckmann = std::exp(-p.tan2_b / alpha2) / (pi * alpha2 * cos4);
      const double d =
          slope_independent_factor(p) *
          std::exp(log_lobe(ShapeSettings{}, SurfaceParameters<double>{.log_slope = std::log(slope)}, 0.0, 1.0, p));
      EXPECT_NEAR(d, 0.25 * pi * beckmann, 1e-12 * d);
    }
  }
}

// The same template at 50 digits, from the same double-precision geometry: round-off of the formula alone.
double dd_error(double slope, const AnglePair& angles) {
  const ShapeSettings settings;
  const Pair p = make_pair(angles);
  const SurfaceParameters<double> s{.log_slope = std::log(slope)};
  const double f = dd_shape(settings, s, surface_terms(settings, s, p), 1.0, p);
  const SurfaceParameters<Big> big{.log_slope = log(Big(slope))};
  const Big truth = dd_shape(settings, big, surface_terms(settings, big, p), 1.0, p);
  if (truth < Big("1e-300")) return 0.0;
  return std::fabs(static_cast<double>((f - truth) / truth)) / (1.0 + std::fabs(static_cast<double>(log(truth))));
}

TEST(DirectionalDiffuse, RoundOffStaysSmallInHardCorners) {
  // Each corner with what a naive form does there.
  const std::vector<AnglePair> corners{
      in_plane(0.0, 0.0),               // ln(1 - cos) is infinite
      in_plane(1e-6, 1e-6),             // 1 - cos is 0 after rounding
      in_plane(45.0, 45.0),             // the mirror: tan² from acos is 1e-16 instead of 0
      in_plane(45.0, 45.0001),          // next to it
      in_plane(89.0, 89.0),             // sigma_e small: 1/m_e² large
      in_plane(89.9, 10.0),             // one grazing: S/c is 0/0
      in_plane(30.0, -30.0),            // retro
      AnglePair{60.0, 0.0, 60.0, 90.0}  // out of the plane
  };
  double worst = 0.0;
  for (const double slope : {1e-6, 1e-3, 0.01, 0.17, 1.0, 10.0}) {
    for (const AnglePair& a : corners) {
      const double error = dd_error(slope, a);
      EXPECT_LT(error, slope < 1e-3 ? 1e-9 : 1e-12) << slope << " at " << a.theta_i_deg << ", " << a.theta_r_deg;
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst_relative_error_over_1_plus_ln_f", std::to_string(worst));
}

}  // namespace
}  // namespace goniofit
