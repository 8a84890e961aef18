#include "synthetic/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "brdf/evaluator.h"
#include "io/scan_reader.h"
#include "support/error.h"
#include "support/error_message.h"
#include "support/materials.h"
#include "synthetic/random.h"

namespace goniofit {
namespace {

MaterialChannel channel(const std::string& name, double wavelength_um, double n, double kappa) {
  return {.name = name, .wavelength_um = wavelength_um, .n = n, .kappa = kappa, .f0 = {}, .k = {}, .peer_k = {}};
}

Material paint() {
  Material m;
  m.name = "paint";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface.slope = 0.1;
  m.channels = {channel("R", 0.65, 1.7, 0.0), channel("G", 0.55, 1.7, 0.0), channel("B", 0.45, 1.7, 0.0)};
  for (MaterialChannel& c : m.channels) {
    c.coefficient(Coefficient::k_dd) = 0.6;
    c.coefficient(Coefficient::k_uds) = 0.3;
    c.coefficient(Coefficient::k_fs) = 1.0;
  }
  return m;
}

Material mirror_metal() {
  Material m;
  m.name = "metal";
  m.components = {Effect::coh, Effect::dd};
  m.surface = test::surface(0.23, 9.9);
  m.channels = {channel("R", 0.65, 1.47, 7.79), channel("G", 0.55, 0.958, 6.69)};
  for (MaterialChannel& c : m.channels) c.coefficient(Coefficient::k_dd) = 1.0;
  return m;
}

std::string metadata(const Scan& scan, const std::string& key) {
  for (const auto& [k, value] : scan.metadata) {
    if (k == key) return value;
  }
  return "(none)";
}

/// (reading - exact) / standard deviation, channel after channel.
std::vector<double> normalised_noise(const Material& material, const Noise& noise, std::uint64_t seed) {
  const Scan exact = simulate(material, Sampling::hemisphere, {}, seed);
  const Scan noisy = simulate(material, Sampling::hemisphere, noise, seed);
  std::vector<double> z;
  for (std::size_t c = 0; c < exact.channels.size(); ++c) {
    for (std::size_t row = 0; row < exact.size(); ++row) {
      const double f = exact.channels[c].values[row];
      z.push_back((noisy.channels[c].values[row] - f) / std::hypot(noise.relative * f, noise.additive));
    }
  }
  return z;
}

// The first outputs of SplitMix64 from state 0, as its authors' reference program prints them.
TEST(Random, IsSplitMix64) {
  RandomStream stream(0);
  EXPECT_EQ(stream.bits(), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(stream.bits(), 0x6e789e6aa1b965f4ULL);
  EXPECT_EQ(stream.bits(), 0x06c45d188009454fULL);
}

TEST(Random, KeysOfNeighboursDiffer) {
  std::set<std::uint64_t> keys;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t row = 0; row < 30; ++row) {
      for (const char* name : {"R", "G", "B"}) keys.insert(subkey(subkey(seed, row), name));
    }
  }
  EXPECT_EQ(keys.size(), 30U * 30U * 3U);
}

TEST(Random, UniformIsInsideItsInterval) {
  RandomStream stream(3);
  double low = 1.0, high = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double u = stream.uniform();
    low = std::min(low, u);
    high = std::max(high, u);
  }
  EXPECT_GT(low, 0.0);
  EXPECT_LT(low, 1e-4);
  EXPECT_LT(high, 1.0);
  EXPECT_GT(high, 1.0 - 1e-4);
}

TEST(Random, LogUniformHasItsMedianAtTheGeometricMean) {
  RandomStream stream(4);
  int below = 0;
  for (int i = 0; i < 10000; ++i) below += stream.log_uniform(0.01, 1.0) < 0.1 ? 1 : 0;
  EXPECT_NEAR(below, 5000, 250);  // five standard deviations
}

TEST(Simulate, WithoutNoiseGivesTheEvaluatorsValues) {
  const Material material = paint();
  const Evaluator evaluator(material);
  const Scan scan = simulate(material, Sampling::hemisphere, {}, 1);
  ASSERT_EQ(scan.channels.size(), 3U);
  for (std::size_t row = 0; row < scan.size(); row += 97) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double f = evaluator.value(make_pair(scan.angles(row)), c);
      EXPECT_NEAR(scan.channels[c].values[row], f, 1e-12 * f);
    }
  }
}

TEST(Simulate, IsAFunctionOfTheSeed) {
  const Scan once = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 7);
  const Scan again = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 7);
  const Scan other = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 8);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(once.channels[c].values, again.channels[c].values);
    EXPECT_NE(once.channels[c].values, other.channels[c].values);
  }
}

TEST(Simulate, AChannelDoesNotDependOnTheOthers) {
  Material alone = paint();
  alone.channels = {alone.channels[1]};
  const Scan all = simulate(paint(), Sampling::incidence_plane, {0.02, 0.001}, 7);
  const Scan one = simulate(alone, Sampling::incidence_plane, {0.02, 0.001}, 7);
  EXPECT_EQ(one.channels[0].values, all.channels[1].values);
}

// Moments of 10584 standard normals, each within five standard errors (1, sqrt 2, sqrt 6, sqrt 24 over sqrt N), and the
// largest distance between their distribution and the normal one (Kolmogorov: 1.95 / sqrt N is passed once in 1000).
TEST(Simulate, NoiseIsGaussianWithTheStatedDeviation) {
  for (const Noise& noise : {Noise{0.02, 0.0}, Noise{0.0, 0.003}, Noise{0.02, 0.003}}) {
    std::vector<double> z = normalised_noise(paint(), noise, 11);
    const auto n = static_cast<double>(z.size());
    double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
    for (const double v : z) {
      m1 += v / n;
      m2 += v * v / n;
      m3 += v * v * v / n;
      m4 += v * v * v * v / n;
    }
    EXPECT_NEAR(m1, 0.0, 5.0 * std::sqrt(1.0 / n));
    EXPECT_NEAR(m2, 1.0, 5.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(m3, 0.0, 5.0 * std::sqrt(15.0 / n));
    EXPECT_NEAR(m4, 3.0, 5.0 * std::sqrt(96.0 / n));

    std::sort(z.begin(), z.end());
    double distance = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double normal = 0.5 * std::erfc(-z[i] / std::sqrt(2.0));
      distance = std::max(distance, std::fabs(normal - (static_cast<double>(i) + 0.5) / n));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(n));
  }
}

TEST(Simulate, NoiseOfNeighboursIsUncorrelated) {
  const std::vector<double> z = normalised_noise(paint(), {0.02, 0.0}, 12);
  const std::size_t rows = z.size() / 3;
  for (const std::size_t lag :
       {std::size_t{1}, std::size_t{21}, rows, 2 * rows}) {  // next row, next line, next channel
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < z.size(); ++i) sum += z[i] * z[i + lag];
    EXPECT_LT(std::fabs(sum), 4.5 * std::sqrt(static_cast<double>(z.size() - lag))) << "lag " << lag;
  }
}

TEST(Simulate, HemisphereHasTheMirrorDirectionsOnlyWithCoherentReflection) {
  EXPECT_EQ(simulate(paint(), Sampling::hemisphere, {}, 1).size(), 8U * 441U);
  const Scan scan = simulate(mirror_metal(), Sampling::hemisphere, {}, 1);
  ASSERT_EQ(scan.size(), 8U * 442U);
  EXPECT_EQ(scan.geometry, ScanGeometry::hemispherical);
  std::size_t mirrors = 0;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (make_pair(scan.angles(row)).mirror_distance2 < 1e-24) ++mirrors;
  }
  EXPECT_EQ(mirrors, 8U);
}

TEST(Simulate, IncidencePlaneHoldsTheMirrorDirectionOfEachIncidence) {
  const Scan scan = simulate(mirror_metal(), Sampling::incidence_plane, {}, 1);
  EXPECT_EQ(scan.geometry, ScanGeometry::incidence_plane);
  std::map<double, int> readings, mirrors;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const double theta_i = scan.theta_i_deg[row];
    EXPECT_NE(scan.plane_side(row), 0);
    EXPECT_LE(scan.theta_r_deg[row], 85.0);
    ++readings[theta_i];
    if (scan.signed_theta_r_deg(row) == theta_i) ++mirrors[theta_i];
  }
  ASSERT_EQ(readings.size(), 5U);
  for (const auto& [theta_i, count] : readings) {
    EXPECT_GE(count, 40) << theta_i;
    EXPECT_LE(count, 70) << theta_i;
    EXPECT_EQ(mirrors[theta_i], 1) << theta_i;
  }
}

TEST(Simulate, StatesItsUncertainty) {
  const Noise noise{0.03, 0.002};
  const Scan exact = simulate(paint(), Sampling::incidence_plane, {}, 1);
  const Scan scan = simulate(paint(), Sampling::incidence_plane, noise, 1, true);
  EXPECT_TRUE(exact.channels[0].u.empty());
  ASSERT_EQ(scan.channels[0].u.size(), scan.size());
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const double f = exact.channels[0].values[row];
    EXPECT_DOUBLE_EQ(scan.channels[0].u[row], std::sqrt(0.0009 * f * f + 4e-6));
  }
}

TEST(Simulate, SaysWhatWasMeasuredAndHow) {
  const Scan plain = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 7);
  EXPECT_EQ(plain.name, "paint");
  EXPECT_EQ(metadata(plain, "name"), "paint");
  EXPECT_EQ(metadata(plain, "made_by"), "goniofit simulate --sampling hemisphere --noise 0.02 --seed 7");
  EXPECT_EQ(plain.channels[2].wavelength_um, 0.45);
  EXPECT_EQ(plain.channels[2].n, 1.7);
  EXPECT_EQ(plain.channels[2].kappa, 0.0);
  EXPECT_FALSE(plain.solid_angle_sr);

  const Scan metal = simulate(mirror_metal(), Sampling::incidence_plane, {0.02, 0.001}, 7);
  EXPECT_EQ(metadata(metal, "made_by"), "goniofit simulate --sampling incidence-plane --noise 0.02,0.001 --seed 7");
  EXPECT_EQ(metal.channels[1].kappa, 6.69);
  EXPECT_EQ(metal.solid_angle_sr, 0.0005);
}

TEST(Simulate, AWrittenScanReadsBack) {
  for (const Sampling sampling : {Sampling::hemisphere, Sampling::incidence_plane}) {
    const Scan scan = simulate(mirror_metal(), sampling, {0.02, 1e-4}, 5, true);
    std::stringstream file;
    write_scan(file, scan, 17);
    const Scan back = read_scan(file, "back.csv");
    EXPECT_EQ(back.name, scan.name);
    EXPECT_EQ(back.geometry, scan.geometry);
    EXPECT_EQ(back.solid_angle_sr, scan.solid_angle_sr);
    EXPECT_EQ(back.theta_i_deg, scan.theta_i_deg);
    EXPECT_EQ(back.theta_r_deg, scan.theta_r_deg);
    EXPECT_EQ(back.phi_r_deg, scan.phi_r_deg);
    EXPECT_EQ(metadata(back, "made_by"), metadata(scan, "made_by"));
    ASSERT_EQ(back.channels.size(), scan.channels.size());
    for (std::size_t c = 0; c < scan.channels.size(); ++c) {
      EXPECT_EQ(back.channels[c].name, scan.channels[c].name);
      EXPECT_EQ(back.channels[c].wavelength_um, scan.channels[c].wavelength_um);
      EXPECT_EQ(back.channels[c].n, scan.channels[c].n);
      EXPECT_EQ(back.channels[c].kappa, scan.channels[c].kappa);
      EXPECT_EQ(back.channels[c].values, scan.channels[c].values);
      EXPECT_EQ(back.channels[c].u, scan.channels[c].u);
    }
  }
}

std::set<double> azimuths(const Scan& scan) { return {scan.phi_i_deg.begin(), scan.phi_i_deg.end()}; }

// One azimuth of incidence cannot tell two slopes from one.
TEST(Simulate, AnAnisotropicMaterialIsTurned) {
  const std::set<double> turned{0.0, 45.0, 90.0};
  Material brushed = paint();
  brushed.surface.slope_y = 0.3;
  for (const Material& material : {brushed, test::anisotropic_ggx()}) {
    const Scan scan = simulate(material, Sampling::incidence_plane, {}, 1);
    EXPECT_EQ(azimuths(scan), turned);
    EXPECT_EQ(scan.geometry, ScanGeometry::hemispherical) << "a scan of the plane has no column for them";
    EXPECT_EQ(scan.size(), 3 * simulate(paint(), Sampling::incidence_plane, {}, 1).size());
    EXPECT_EQ(metadata(scan, "made_by"),
              "goniofit simulate --sampling incidence-plane --phi-i 0,45,90 --noise 0 --seed 1");
    const Evaluator evaluator(material);
    bool differs = false;
    for (std::size_t row = 0; row < scan.size(); ++row) {
      EXPECT_NE(scan.plane_side(row), 0) << "turned together";
      const AnglePair a = scan.angles(row);
      const double f = evaluator.value(make_pair(a), 0);
      EXPECT_NEAR(scan.channels[0].values[row], f, 1e-12 * f);
      const double unturned =
          evaluator.value(make_pair({a.theta_i_deg, 0.0, a.theta_r_deg, a.phi_r_deg - a.phi_i_deg}), 0);
      differs = differs || std::fabs(f - unturned) > 0.1 * unturned;
    }
    EXPECT_TRUE(differs);
  }
  Material equal_widths = test::anisotropic_ggx();
  equal_widths.parameters["alpha_y"] = equal_widths.parameters["alpha_x"];
  EXPECT_EQ(azimuths(simulate(equal_widths, Sampling::hemisphere, {}, 1)), std::set<double>{0.0});
}

TEST(Simulate, AzimuthsOfIncidenceAreThoseAskedFor) {
  const Scan scan = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 7, false, {0.0, 30.0});
  EXPECT_EQ(azimuths(scan), (std::set<double>{0.0, 30.0}));
  EXPECT_EQ(metadata(scan, "made_by"), "goniofit simulate --sampling hemisphere --phi-i 0,30 --noise 0.02 --seed 7");
  // The readings of azimuth 0 are those of a scan of azimuth 0 alone.
  const Scan plain = simulate(paint(), Sampling::hemisphere, {0.02, 0.0}, 7);
  for (std::size_t row = 0; row < plain.size(); row += 89) {
    EXPECT_EQ(scan.channels[1].values[row], plain.channels[1].values[row]);
  }
  const auto complaint = [](const std::vector<double>& phi) {
    return test::error_message([&] { (void)simulate(paint(), Sampling::hemisphere, {}, 1, false, phi); });
  };
  EXPECT_EQ(complaint({0.0, std::nan("")}), "2 azimuth of incidence nan: expected a finite number");
  EXPECT_EQ(complaint({-90.0, 270.0}), "2 azimuth of incidence 270: is given twice, expected each once");
}

// What has its peak in the mirror direction has that direction; only what the solid angle gives a height states it.
TEST(Simulate, MirrorDirectionsWhereAPeakIsThere) {
  Material wave = mirror_metal();
  wave.components = {Effect::dd};
  wave.terms.distribution = DistributionTier::he_torrance;
  const Scan of_wave = simulate(wave, Sampling::hemisphere, {}, 1);
  EXPECT_EQ(of_wave.size(), 8U * 442U);
  EXPECT_FALSE(of_wave.solid_angle_sr);
  wave.components = {Effect::udf};
  EXPECT_EQ(simulate(wave, Sampling::hemisphere, {}, 1).size(), 8U * 441U);
  Material schlick;
  schlick.model = "schlick-single-isotropic";
  schlick.parameters = {{"r", 0.01}};
  schlick.channels = {channel("R", 0.65, 1.5, 0.0)};
  schlick.channels[0].peer_k = {{"C", 0.5}};
  const Scan of_schlick = simulate(schlick, Sampling::hemisphere, {}, 1);
  EXPECT_EQ(of_schlick.size(), 8U * 442U);
  EXPECT_EQ(of_schlick.solid_angle_sr, 0.0005);
}

TEST(Simulate, RefusesWhatIsNoNoiseAndNoMaterial) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Noise& noise : {Noise{-0.1, 0.0}, Noise{0.0, -1e-9}, Noise{nan, 0.0}, Noise{0.0, infinity}}) {
    EXPECT_THROW((void)simulate(paint(), Sampling::hemisphere, noise, 1), Error);
  }
  EXPECT_THROW((void)simulate(paint(), Sampling::hemisphere, {}, 1, true), Error);
  // Far from the lobe of a smooth metal f underflows to 0, and relative noise with it.
  EXPECT_THROW((void)simulate(mirror_metal(), Sampling::hemisphere, {0.02, 0.0}, 1, true), Error);
  Material broken = paint();
  broken.surface.slope = -1.0;
  EXPECT_THROW((void)simulate(broken, Sampling::hemisphere, {}, 1), Error);
}

}  // namespace
}  // namespace goniofit
