// Pictures written are pictures read, by libpng itself.

#include "io/png_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include "support/error.h"

namespace goniofit {
namespace {

RgbPicture gradient(std::size_t width, std::size_t height) {
  RgbPicture picture{width, height, {}};
  for (std::size_t i = 0; i < 3 * width * height; ++i) picture.bytes.push_back(static_cast<std::uint8_t>(i * 37));
  return picture;
}

TEST(PngFile, ReadsBack) {
  const RgbPicture picture = gradient(17, 9);
  const std::string bytes = to_png(picture, {{"Description", "σ/τ = 0.1"}, {"goniofit.scene", ""}});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  ASSERT_EQ(image.width, 17U);
  ASSERT_EQ(image.height, 9U);
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB)) << "8 bits, sRGB";
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(read, picture.bytes);
  EXPECT_NE(bytes.find("σ/τ = 0.1"), std::string::npos);
  EXPECT_EQ(bytes, to_png(picture, {{"Description", "σ/τ = 0.1"}, {"goniofit.scene", ""}}));
}

TEST(PngFile, RefusesWhatIsNoPicture) {
  EXPECT_THROW((void)to_png({}), Error);
  EXPECT_THROW((void)to_png({2, 2, std::vector<std::uint8_t>(11)}), Error);
  EXPECT_THROW((void)to_png(gradient(2, 2), {{"", "x"}}), Error);
  EXPECT_THROW((void)to_png(gradient(2, 2), {{std::string(80, 'k'), "x"}}), Error);
  EXPECT_THROW((void)to_png(gradient(2, 2), {{"line\n", "x"}}), Error);
}

}  // namespace
}  // namespace goniofit
