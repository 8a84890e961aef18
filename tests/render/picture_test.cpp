// Colours, files, and the numbers that pixels are sampled by.

#include <gtest/gtest.h>

#include <set>

#include "render/color.h"
#include "render/exr_image.h"
#include "render/picture_file.h"
#include "render/pixel_samples.h"
#include "render/spectral_exr.h"
#include "render_support.h"
#include "support/error.h"
#include "support/paths.h"

namespace goniofit::test {
namespace {

std::vector<SceneChannel> bands(double from_um, double to_um, std::size_t n) {
  std::vector<SceneChannel> channels;
  for (std::size_t i = 0; i < n; ++i) {
    const double um = from_um + (to_um - from_um) * static_cast<double>(i) / static_cast<double>(n - 1);
    channels.push_back({std::to_string(i), um});
  }
  return channels;
}

std::array<double, 3> color_of(const std::vector<SceneChannel>& channels, const std::vector<double>& spectrum) {
  const auto rgb = linear_rgb({1, 1, channels, spectrum});
  return {rgb[0], rgb[1], rgb[2]};
}

TEST(Color, ThreePrimariesAreThemselvesInAnyOrder) {
  EXPECT_EQ(color_of({{"b", {}}, {"R", {}}, {"G", {}}}, {3, 1, 2}), (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(color_of({{"x", 0.65}, {"y", 0.55}, {"z", 0.45}}, {1, 2, 3}), (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(color_of({{"550nm", 0.55}}, {2}), (std::array{2.0, 2.0, 2.0}));
  EXPECT_EQ(color_of({{"a", {}}, {"b", {}}}, {1, 3}), (std::array{2.0, 2.0, 2.0}));
}

TEST(Color, AFlatSpectrumIsWhiteAndABandHasItsHue) {
  const auto channels = bands(0.4, 0.7, 31);
  const auto white = color_of(channels, std::vector<double>(31, 0.5));
  for (const double c : white) EXPECT_NEAR(c, 0.5, 1e-12);
  const auto band = [&](std::size_t i) {
    std::vector<double> spectrum(31, 0.0);
    spectrum[i] = 1.0;
    return color_of(channels, spectrum);
  };
  EXPECT_GT(band(24)[0], 5.0 * std::fabs(band(24)[1])) << "640 nm is red";
  EXPECT_GT(band(13)[1], 2.0 * band(13)[0]) << "530 nm is green";
  EXPECT_GT(band(5)[2], 5.0 * std::fabs(band(5)[1])) << "450 nm is blue";
}

// The maximum of y-bar is 1 at 555 nm (CIE 1931); the fit's error there is below 1 %.
TEST(Color, LuminanceFollowsTheObserver) {
  const auto channels = bands(0.36, 0.83, 471);
  const auto weights = rgb_weights(channels);
  // Undo the white scale by the ratio of two bands: y-bar(600) / y-bar(555) = 0.631 / 1, in absolute XYZ.
  const auto green = weights[555 - 360], orange = weights[600 - 360], blue = weights[470 - 360];
  EXPECT_GT(green[1], 0.0);
  EXPECT_LT(green[0] + green[2], green[1] + 1e-3);
  EXPECT_GT(orange[0], 2.0 * orange[1]);
  EXPECT_LT(blue[0], blue[2]);
}

TEST(Color, ExposurePutsTheBrightPartAtFourFifths) {
  std::vector<double> rgb;
  for (int i = 0; i < 1000; ++i) rgb.insert(rgb.end(), 3, i < 500 ? 0.0 : 0.1);
  EXPECT_NEAR(0.1 * std::exp2(automatic_exposure(rgb)), 0.8, 1e-12);
  EXPECT_EQ(automatic_exposure(std::vector<double>(30, 0.0)), 0.0);
  const Picture picture{
      3, 1, {{"R", {}}, {"G", {}}, {"B", {}}}, {0, 0.5, 1e9, -1, 0.0031308, 1, 0.21586, 0.21586, 0.21586}};
  const RgbPicture screen = for_screen(picture, linear_rgb(picture), 0.0);
  EXPECT_EQ(screen.bytes[0], 0);
  EXPECT_EQ(screen.bytes[1], 188) << "sRGB of 0.5";
  EXPECT_EQ(screen.bytes[2], 255);
  EXPECT_EQ(screen.bytes[3], 0);
  EXPECT_EQ(screen.bytes[4], 10);
  EXPECT_LT(screen.bytes[5], 250) << "bent";
  EXPECT_EQ(screen.bytes[6], 128) << "128 is sRGB of 0.21586";
}

TEST(PictureFile, SpectralLayoutIsReadBack) {
  const ScratchDir folder;
  Picture picture{2, 1, {{"a", 0.45}, {"b", 0.55}, {"c", 0.5}, {"d", 0.65}}, {1, 2, 3, 4, 5, 6, 7, 1e300}};
  write_picture(folder / "p.exr", picture, std::nullopt, {{"goniofit.plan", "fs left out"}});
  const ExrImage image = read_exr_image(folder / "p.exr");
  EXPECT_EQ(image.width, 2U);
  EXPECT_EQ(image.height, 1U);
  const std::vector<std::string> names{
      "B", "G", "R", "S0.450,000000nm", "S0.500,000000nm", "S0.550,000000nm", "S0.650,000000nm"};
  EXPECT_EQ(image.channels, names);
  EXPECT_EQ(image.values[3], (std::vector<float>{1, 5}));
  EXPECT_EQ(image.values[4], (std::vector<float>{3, 7}));
  EXPECT_EQ(image.values[6], (std::vector<float>{4, std::numeric_limits<float>::max()}));
  const std::set<std::pair<std::string, std::string>> texts(image.attributes.begin(), image.attributes.end());
  EXPECT_TRUE(texts.contains({"spectralLayoutVersion", "1.0"}));
  EXPECT_TRUE(texts.contains({"emissiveUnits", "W.m^-2.sr^-1"}));
  EXPECT_TRUE(texts.contains({"goniofit.plan", "fs left out"}));
}

TEST(PictureFile, ThreeChannelsAreRgbAlone) {
  const ScratchDir folder;
  write_picture(folder / "p.exr", {1, 1, {{"B", 0.45}, {"G", 0.55}, {"R", 0.65}}, {3, 2, 1}}, std::nullopt);
  const ExrImage image = read_exr_image(folder / "p.exr");
  EXPECT_EQ(image.channels, (std::vector<std::string>{"B", "G", "R"}));
  EXPECT_EQ(image.values[0][0], 3.0F);
  EXPECT_EQ(image.values[2][0], 1.0F);
}

TEST(PictureFile, OtherEndingsAreRefused) {
  const Picture picture{1, 1, {{"R", {}}}, {1}};
  EXPECT_THROW(write_picture("p.jpg", picture, std::nullopt), Error);
  EXPECT_THROW(write_picture("/nowhere/p.png", picture, std::nullopt), Error);
  EXPECT_THROW(write_picture("/nowhere/p.exr", picture, std::nullopt), Error);
}

TEST(PictureFile, SideBySideKeepsRowsTogether) {
  const std::vector<SceneChannel> one{{"R", {}}};
  const Picture joined = side_by_side({{1, 2, one, {1, 2}}, {2, 2, one, {3, 4, 5, 6}}});
  EXPECT_EQ(joined.width, 3U);
  EXPECT_EQ(joined.radiance, (std::vector<double>{1, 3, 4, 2, 5, 6}));
  EXPECT_THROW((void)side_by_side({{1, 2, one, {1, 2}}, {1, 1, one, {3}}}), Error);
}

TEST(SpectralExr, NamesAreReadBack) {
  EXPECT_EQ(spectral_channel_name(450.0), "S0.450,000000nm");
  EXPECT_EQ(spectral_band_nm("S0.450,500000nm"), 450.5);
  for (const char* const other : {"R", "S1.450,0nm", "S0.nm", "S0.450", "S0.4x0nm"})
    EXPECT_FALSE(spectral_band_nm(other));
}

// A (0, 2)-sequence: of the first 2^m points every elementary interval of area 2^-m holds exactly one.
TEST(PixelSamples, AreANetOfEveryShape) {
  for (const std::uint64_t key : {1U, 2U, 77U}) {
    for (std::uint32_t m = 0; m <= 8; ++m) {
      const std::uint32_t n = 1U << m;
      for (std::uint32_t a = 0; a <= m; ++a) {
        std::set<std::pair<unsigned, unsigned>> boxes;
        for (std::uint32_t i = 0; i < n; ++i) {
          const auto u = sample_pair(key, i);
          ASSERT_TRUE(u[0] >= 0.0 && u[0] < 1.0 && u[1] >= 0.0 && u[1] < 1.0);
          boxes.insert({static_cast<unsigned>(u[0] * (1U << a)), static_cast<unsigned>(u[1] * (1U << (m - a)))});
        }
        EXPECT_EQ(boxes.size(), n) << key << " " << m << " " << a;
      }
    }
  }
}

TEST(PixelSamples, OfDifferentKeysAreIndependent) {
  constexpr std::uint64_t keys = 4000;
  double products = 0.0, mean = 0.0;
  for (std::uint64_t key = 0; key < keys; ++key) {
    const double a = sample_pair(pixel_samples::combined(3, key), 0)[0] - 0.5;
    const double b = sample_pair(pixel_samples::combined(3, key + 1), 0)[0] - 0.5;
    products += a * b;
    mean += a;
  }
  // Standard deviations 1/12 and sqrt(1/12) over sqrt(keys).
  EXPECT_LT(std::fabs(products / keys), 4.0 / 12.0 / std::sqrt(static_cast<double>(keys)));
  EXPECT_LT(std::fabs(mean / keys), 4.0 * std::sqrt(1.0 / 12.0 / static_cast<double>(keys)));
}

}  // namespace
}  // namespace goniofit::test
