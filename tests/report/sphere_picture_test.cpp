// The picture of a sphere: where the light falls, and as brightly as the cosine says.

#include "report/sphere_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "brdf/paper_samples.h"
#include "geometry/angles.h"

namespace goniofit::test {
namespace {

Material lambert() {
  Material m;
  m.name = "diffuse";
  m.components = EffectSet{Effect::udf};
  m.channels.resize(1);
  m.channels[0].name = "grey";
  m.channels[0].coefficient(Coefficient::k_udf) = 0.5;
  return m;
}

double linear(std::uint8_t encoded) {
  const double c = encoded / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(SpherePicture, OfADiffuserFollowsTheCosine) {
  const SpherePicture picture = sphere_picture(lambert(), 200);
  ASSERT_EQ(picture.rgb.size(), 3U * 200 * 200);
  // The light stands at (-0.55, 0.6, 0.85).
  const double length = std::sqrt(0.55 * 0.55 + 0.6 * 0.6 + 0.85 * 0.85);
  const auto shade = [&](double x, double y) {
    const auto column = static_cast<std::size_t>((1.0 + 0.94 * x) * 100.0);
    const auto row = static_cast<std::size_t>((1.0 - 0.94 * y) * 100.0);
    return linear(picture.rgb[3 * (row * 200 + column)]);
  };
  const auto cosine = [&](double x, double y) {
    return (-0.55 * x + 0.6 * y + 0.85 * std::sqrt(1.0 - x * x - y * y)) / length;
  };
  // Nothing is above white, so nothing is compressed: ratios of shades are those of cosines.
  const double reference = shade(0.0, 0.0) / cosine(0.0, 0.0);
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{-0.5, 0.5}, {-0.2, 0.7}, {0.3, 0.3}, {0.2, -0.4}})
    EXPECT_NEAR(shade(x, y) / cosine(x, y), reference, 0.04 * reference) << x << ' ' << y;
  EXPECT_EQ(shade(0.7, -0.6), 0.0) << "no light behind the terminator";
  EXPECT_NEAR(shade(-1.0, 1.0), 0.42, 0.01) << "the background";
}

TEST(SpherePicture, ExposureIsStatedAgainstWhite) {
  Material white = lambert();
  white.channels[0].coefficient(Coefficient::k_udf) = 1.0;
  const double of_white = sphere_picture(white, 64).exposure;
  EXPECT_NEAR(sphere_picture(lambert(), 64).exposure, 2.0 * of_white, 1e-9);
  white.channels[0].coefficient(Coefficient::k_udf) = 0.0;
  EXPECT_NEAR(sphere_picture(white, 64).exposure, 0.8 * 40.0, 1e-9) << "the longest";
}

TEST(SpherePicture, ARedPaintIsRedWithAWhiteHighlight) {
  const SpherePicture picture = sphere_picture(garnet_red_paint_13(), 100);
  std::size_t red = 0;
  std::size_t white = 0;
  for (std::size_t p = 0; p < picture.rgb.size(); p += 3) {
    const auto [r, g, b] = std::array{picture.rgb[p], picture.rgb[p + 1], picture.rgb[p + 2]};
    red += r > 100 && g < 60 && b < 60 ? 1U : 0U;
    white += std::min({r, g, b}) > 220 ? 1U : 0U;
  }
  EXPECT_GT(red, 2000U);
  EXPECT_GT(white, 20U);
  EXPECT_LT(white, 500U);
}

TEST(SpherePicture, ChoosesBandsByNameThenByWavelength) {
  EXPECT_EQ(picture_bands(garnet_red_paint_13()).channel, (std::array<std::size_t, 3>{0, 1, 2}));
  Material spectral = lambert();
  spectral.channels.clear();
  for (int nm = 400; nm <= 700; nm += 10) {
    MaterialChannel channel{
        .name = std::to_string(nm) + "nm", .wavelength_um = nm / 1000.0, .n = {}, .kappa = {}, .f0 = {}};
    channel.coefficient(Coefficient::k_udf) = 0.5;
    spectral.channels.push_back(channel);
  }
  const PictureBands bands = picture_bands(spectral);
  EXPECT_EQ(spectral.channels[bands.channel[0]].name, "610nm");
  EXPECT_EQ(spectral.channels[bands.channel[2]].name, "460nm");
  EXPECT_EQ(bands.text, "610nm, 550nm and 460nm as red, green and blue");
  EXPECT_EQ(picture_bands(lambert()).text, "grey as grey");
}

}  // namespace
}  // namespace goniofit::test
