#include "scan/scan_domain.h"

#include <gtest/gtest.h>

#include "support/error.h"

namespace goniofit::test {
namespace {

Scan scan_of(std::vector<double> theta_i, std::vector<double> theta_r) {
  Scan scan;
  scan.source = "s.csv";
  scan.theta_i_deg = std::move(theta_i);
  scan.theta_r_deg = std::move(theta_r);
  scan.channels = {{"R", 0.65, {}, {}, {}, {}}, {"G", 0.55, {}, {}, {}, {}}};
  return scan;
}

TEST(ScanDomain, SpansItsReadings) {
  Scan scan = scan_of({15.0, 75.0, 30.0, 90.0}, {85.0, 10.0, 60.0, 90.0});
  scan.solid_angle_sr = 0.002;
  const Domain expected{.theta_i_min_deg = 15.0,
                        .theta_i_max_deg = 75.0,
                        .theta_r_max_deg = 85.0,
                        .wavelengths_um = {0.65, 0.55},
                        .solid_angle_sr = 0.002};
  EXPECT_EQ(domain_of(scan), expected) << "90 degrees is left out";
}

TEST(ScanDomain, AllChannelsCountWhereOneHasNoWavelength) {
  Scan scan = scan_of({10.0}, {10.0});
  scan.channels[1].wavelength_um.reset();
  EXPECT_TRUE(domain_of(scan).wavelengths_um.empty());
}

TEST(ScanDomain, NeedsAReading) { EXPECT_THROW((void)domain_of(scan_of({90.0}, {10.0})), Error); }

}  // namespace
}  // namespace goniofit::test
