#include "cost/error_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"
#include "support/error_message.h"
#include "support/materials.h"

namespace goniofit::test {
namespace {

constexpr Domain to_60{.theta_i_min_deg = 10.0, .theta_i_max_deg = 50.0, .theta_r_max_deg = 60.0};

TEST(ErrorSamples, StayInTheDomainAndAreTheSameForASeed) {
  const ErrorSettings settings{.incidences = 5, .directions = 200};
  const ErrorSamples s = error_samples(garnet_red_paint_13(), to_60, settings);
  EXPECT_EQ(s.theta_i_deg, (std::vector<double>{10.0, 20.0, 30.0, 40.0, 50.0}));
  EXPECT_EQ(s.first.size(), 6U);
  EXPECT_EQ(s.first.back(), s.directions.size());
  EXPECT_EQ(s.weights.size(), s.directions.size());
  for (std::size_t i = 0; i < s.directions.size(); ++i) EXPECT_GE(s.directions.v_z[i], cos_deg(60.0)) << i;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(s.mirrors.l_z[i], cos_deg(s.theta_i_deg[i]), 1e-15);
    EXPECT_EQ(s.mirrors.v_x[i], -s.mirrors.l_x[i]);
    EXPECT_NEAR(s.directions.l_z[s.first[i]], s.mirrors.l_z[i], 1e-15);
  }
  EXPECT_EQ(error_samples(garnet_red_paint_13(), to_60, settings).directions.v_x, s.directions.v_x);
  const ErrorSettings other{.incidences = 5, .directions = 200, .seed = 2};
  EXPECT_NE(error_samples(garnet_red_paint_13(), to_60, other).directions.v_x, s.directions.v_x);
}

TEST(ErrorSamples, RandomIncidencesCoverTheirStrata) {
  const ErrorSettings settings{.incidences = 8, .directions = 10, .random_incidence = true, .seed = 5};
  const ErrorSamples s = error_samples(garnet_red_paint_13(), to_60, settings);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GE(s.theta_i_deg[i], 10.0 + 5.0 * static_cast<double>(i));
    EXPECT_LE(s.theta_i_deg[i], 15.0 + 5.0 * static_cast<double>(i));
  }
}

// The weights estimate the integral of cos theta over the cap, sin²(60°) pi, whatever the lobe.
TEST(ErrorSamples, WeightsIntegrateTheCosine) {
  for (const Material& m : {garnet_red_paint_13(), laser_paper_73(), ground_glass_41(), smooth_aluminium_45()}) {
    const ErrorSamples s = error_samples(m, to_60, {.incidences = 5, .directions = 8000});
    for (std::size_t i = 0; i < 5; ++i) {
      double sum = 0.0;
      double squares = 0.0;
      for (std::size_t k = s.first[i]; k < s.first[i + 1]; ++k) {
        sum += s.weights[k];
        squares += s.weights[k] * s.weights[k];
      }
      const double mean = sum / s.drawn;
      const double standard_error = std::sqrt((squares / s.drawn - mean * mean) / s.drawn);
      EXPECT_NEAR(mean, 0.75 * pi, 4.5 * standard_error) << m.name << " at " << s.theta_i_deg[i];
      EXPECT_LT(standard_error, 0.05);
    }
  }
}

TEST(ErrorSamples, RefuseAnImpossibleDomain) {
  const auto samples = [](const Domain& d) { return error_samples(garnet_red_paint_13(), d, {}); };
  EXPECT_THROW((void)samples({.theta_i_min_deg = 50.0, .theta_i_max_deg = 40.0}), Error);
  EXPECT_THROW((void)samples({.theta_i_max_deg = 90.0}), Error);
  EXPECT_THROW((void)samples({.theta_r_max_deg = 0.0}), Error);
  EXPECT_THROW((void)samples({.wavelengths_um = {-1.0}}), Error);
  EXPECT_THROW((void)samples({.solid_angle_sr = 7.0}), Error);
}

}  // namespace
}  // namespace goniofit::test
