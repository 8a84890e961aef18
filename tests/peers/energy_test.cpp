// How much light each model returns: F = 1, one lobe of strength 1 and nothing else.

#include <gtest/gtest.h>

#include <string>

#include "peer_support.h"
#include "quadrature.h"

namespace goniofit {
namespace {

// Width of the lobe in the half vector's slopes.
double lobe_width(const std::string& model, double shape) {
  if (model == "blinn-phong") return std::sqrt(2.0 / shape);
  if (model == "neumann-neumann" || model == "lafortune-1") return std::sqrt(0.5 / shape);
  return shape;
}

struct Albedo {
  double value, shape, theta_i_deg;
};

double lobe_albedo(const std::string& model, double shape, double theta_i_deg) {
  const auto basis = make_peer(model, 0.0);
  std::vector<double> z{std::log(shape)};
  z.resize(basis->shape_parameters().size(), 0.0);
  std::vector<double> k = test::unit_coefficients(*basis);
  if (k.size() > 1 && basis->coefficients()[0].name == "k_d") k[0] = 0.0;
  // F = 1; but a clear layer shares the light with what it covers.
  const FresnelTier tier = model.starts_with("schlick-double") ? FresnelTier::exact : FresnelTier::none;
  const ChannelOptics glass = ChannelOptics::of_index(1.5, 0.0);
  const auto f = [&](const Pair& p) { return test::value(*basis, p, z, k, glass, tier); };
  if (model.starts_with("schlick")) return test::broad_albedo(f, theta_i_deg);
  return test::directional_albedo(f, theta_i_deg, std::min(1.0, lobe_width(model, shape)));
}

Albedo largest_albedo(const std::string& model, const std::vector<double>& shapes) {
  Albedo largest{0.0, 0.0, 0.0};
  for (const double shape : shapes) {
    for (const double theta_i : {0.0, 30.0, 60.0, 75.0, 85.0}) {
      const double albedo = lobe_albedo(model, shape, theta_i);
      if (albedo > largest.value) largest = {albedo, shape, theta_i};
    }
  }
  std::printf("%-26s largest albedo %.3f (shape %g, theta_i %g)\n", model.c_str(), largest.value, largest.shape,
              largest.theta_i_deg);
  return largest;
}

const std::vector<double> widths{0.01, 0.05, 0.2, 0.5, 1.0, 2.0};
const std::vector<double> exponents{1.0, 3.0, 10.0, 100.0, 10000.0};

TEST(PeerEnergy, FacetModelsReturnNoMoreThanTheyGet) {
  for (const char* model : {"cook-torrance", "ggx", "ggx-anisotropic"})
    EXPECT_LT(largest_albedo(model, widths).value, 1.003) << model;
  // At normal incidence a narrow lobe with F = 1 returns all.
  EXPECT_NEAR(lobe_albedo("cook-torrance", 0.01, 0.0), 1.0, 2e-3);
  EXPECT_NEAR(lobe_albedo("ggx", 0.01, 0.0), 1.0, 2e-3);
}

TEST(PeerEnergy, NormalisationsAreThoseOfTheHeaders) {
  for (const double n : exponents) {
    EXPECT_NEAR(lobe_albedo("neumann-neumann", n, 0.0), 1.0, 3e-3) << n;
    EXPECT_NEAR(lobe_albedo("lafortune-1", n, 0.0), 1.0, 3e-3) << n;
  }
  EXPECT_LT(largest_albedo("neumann-neumann", exponents).value, 1.003);
  EXPECT_LT(largest_albedo("lafortune-1", exponents).value, 1.003);
  // Blinn-Phong: 4 cos² theta_i for narrow lobes.
  EXPECT_NEAR(lobe_albedo("blinn-phong", 10000.0, 0.0), 4.0, 0.01);
  EXPECT_NEAR(lobe_albedo("blinn-phong", 10000.0, 60.0), 1.0, 0.01);
  EXPECT_NEAR(largest_albedo("blinn-phong", exponents).value, 4.0, 0.01);
  // Ward narrow: sec⁴ theta_b and the cosines of its lobe are all that is missing.
  EXPECT_NEAR(lobe_albedo("ward", 0.01, 0.0), 1.0, 2e-3);
  EXPECT_LT(largest_albedo("ward", widths).value, 1.003);
  EXPECT_LT(largest_albedo("ward-anisotropic", widths).value, 1.003);
}

// Schlick's (30) passes 1 at 59° for r = ½ and grows as 1/cos: the light that G hides is emitted over 1/(v v').
TEST(PeerEnergy, SchlicksReemittedLightHasNoBound) {
  EXPECT_NEAR(lobe_albedo("schlick-single-isotropic", 0.5, 0.0), 0.644, 0.002);
  EXPECT_NEAR(lobe_albedo("schlick-single-isotropic", 0.5, 55.0), 0.917, 0.003);
  EXPECT_NEAR(lobe_albedo("schlick-single-isotropic", 0.5, 60.0), 1.026, 0.003);
  EXPECT_NEAR(lobe_albedo("schlick-single-isotropic", 0.5, 85.0), 5.627, 0.01);
  EXPECT_NEAR(lobe_albedo("schlick-single-isotropic", 1.0, 85.0), 1.0, 1e-4);  // Lambert
  EXPECT_NEAR(largest_albedo("schlick-single", {0.1, 0.3, 0.5, 0.9}).value, 5.627, 0.01);
  // Over a Lambert base: the clear layer passes on the fault, as far as F lets it.
  EXPECT_GT(largest_albedo("schlick-double", {0.1, 0.3, 0.5, 0.9}).value, 1.3);
}

}  // namespace
}  // namespace goniofit
