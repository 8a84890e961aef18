#include "render/picture_file.h"

#include <algorithm>
#include <limits>

#include "io/number.h"
#include "render/color.h"
#include "render/exr_image.h"
#include "render/spectral_exr.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

float as_float(double value) {
  constexpr auto most = static_cast<double>(std::numeric_limits<float>::max());
  return static_cast<float>(std::clamp(value, -most, most));
}

bool is_spectral(const Picture& picture) {
  return picture.channels.size() > 3 && std::all_of(picture.channels.begin(), picture.channels.end(),
                                                    [](const SceneChannel& c) { return c.wavelength_um.has_value(); });
}

ExrImage exr_of(const Picture& picture, const PictureNotes& notes) {
  ExrImage image{picture.width, picture.height, {}, {}, notes};
  const std::size_t pixels = picture.width * picture.height;
  const auto add = [&](const std::string& name, const std::vector<double>& from, std::size_t stride,
                       std::size_t channel) {
    image.channels.push_back(name);
    std::vector<float>& values = image.values.emplace_back(pixels);
    for (std::size_t i = 0; i < pixels; ++i) values[i] = as_float(from[i * stride + channel]);
  };
  const std::vector<double> rgb = linear_rgb(picture);
  constexpr std::array<const char*, 3> names{"R", "G", "B"};
  for (std::size_t k = 0; k < 3; ++k) add(names[k], rgb, 3, k);
  if (!is_spectral(picture)) return image;
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    add(spectral_channel_name(1e3 * *picture.channels[c].wavelength_um), picture.radiance, picture.channels.size(), c);
  }
  image.attributes.emplace_back("spectralLayoutVersion", "1.0");
  image.attributes.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
  return image;
}

}  // namespace

void expect_picture_name(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  if (ending != ".exr" && ending != ".png") {
    throw usage_error(path.string() + ": a picture needs a name that ends in .exr or .png");
  }
}

void write_picture(const std::filesystem::path& path, const Picture& picture, std::optional<double> exposure_stops,
                   const PictureNotes& notes) {
  expect_picture_name(path);
  if (lower_case(path.extension().string()) == ".exr") {
    write_exr_image(path, exr_of(picture, notes));
    return;
  }
  const std::vector<double> rgb = linear_rgb(picture);
  write_png(path, for_screen(picture, rgb, exposure_stops ? *exposure_stops : automatic_exposure(rgb)), notes);
}

Picture side_by_side(const std::vector<Picture>& pictures) {
  Picture joined{0, pictures.front().height, pictures.front().channels, {}};
  for (const Picture& p : pictures) {
    if (p.height != joined.height || p.channels.size() != joined.channels.size()) {
      throw usage_error("pictures of different heights or channels, expected alike ones side by side");
    }
    joined.width += p.width;
  }
  for (std::size_t row = 0; row < joined.height; ++row) {
    for (const Picture& p : pictures) {
      const std::size_t stride = p.width * p.channels.size();
      const auto begin = p.radiance.begin() + static_cast<std::ptrdiff_t>(row * stride);
      joined.radiance.insert(joined.radiance.end(), begin, begin + static_cast<std::ptrdiff_t>(stride));
    }
  }
  return joined;
}

}  // namespace goniofit
