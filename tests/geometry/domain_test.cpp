#include "geometry/domain.h"

#include <gtest/gtest.h>

#include "support/error_message.h"

namespace goniofit::test {
namespace {

TEST(Domain, IsValidWithinTheHemisphere) {
  EXPECT_EQ(error_message([] { validate({}); }), "no error");
  EXPECT_EQ(error_message([] { validate({.theta_i_min_deg = 30.0, .theta_i_max_deg = 30.0, .theta_r_max_deg = 1.0}); }),
            "no error");
}

TEST(Domain, SaysWhatIsWrong) {
  const auto complaint = [](const Domain& d) { return error_message([&] { validate(d); }); };
  EXPECT_NE(complaint({.theta_i_min_deg = 50.0, .theta_i_max_deg = 40.0}).find("incidence from 50 to 40 degrees"),
            std::string::npos);
  EXPECT_NE(complaint({.theta_i_max_deg = 90.0}).find("expected two angles in [0, 90)"), std::string::npos);
  EXPECT_NE(complaint({.theta_i_min_deg = -1.0}).find("incidence"), std::string::npos);
  EXPECT_NE(complaint({.theta_r_max_deg = 91.0}).find("directions up to 91"), std::string::npos);
  EXPECT_NE(complaint({.wavelengths_um = {0.5, 0.0}}).find("wavelength 0 um"), std::string::npos);
  EXPECT_NE(complaint({.solid_angle_sr = -0.1}).find("solid angle -0.1 sr"), std::string::npos);
}

}  // namespace
}  // namespace goniofit::test
