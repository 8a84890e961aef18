#include "render/color.h"

#include <algorithm>
#include <cmath>

#include "io/number.h"

namespace goniofit {

namespace {

// A Gaussian whose two sides have widths of their own; the arguments are (3) of the paper.
double lobe(double nm, double peak, double below, double above) {
  const double t = (nm - peak) * (nm < peak ? below : above);
  return std::exp(-0.5 * t * t);
}

std::array<double, 3> observer_1931(double nm) {
  const double x = 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
                   0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
  const double y = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
  const double z = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
  return {x, y, z};
}

// IEC 61966-2-1.
std::array<double, 3> rgb_of_xyz(const std::array<double, 3>& c) {
  return {3.2406 * c[0] - 1.5372 * c[1] - 0.4986 * c[2], -0.9689 * c[0] + 1.8758 * c[1] + 0.0415 * c[2],
          0.0557 * c[0] - 0.2040 * c[1] + 1.0570 * c[2]};
}

bool are_primaries(const std::vector<SceneChannel>& channels, std::array<std::size_t, 3>& place) {
  constexpr std::array<const char*, 3> names{"r", "g", "b"};
  constexpr std::array<double, 3> wavelengths_um{0.65, 0.55, 0.45};
  if (channels.size() != 3) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find_if(channels.begin(), channels.end(), [&](const SceneChannel& c) {
      const bool there = c.wavelength_um && std::fabs(*c.wavelength_um - wavelengths_um[k]) < 1e-6;
      return lower_case(c.name) == names[k] || there;
    });
    if (found == channels.end()) return false;
    place[k] = static_cast<std::size_t>(found - channels.begin());
  }
  return true;
}

// Integral of the observer over what lies nearest to each channel, within the visible range.
std::vector<std::array<double, 3>> spectral_weights(const std::vector<SceneChannel>& channels) {
  constexpr int first_nm = 360, last_nm = 830;
  std::vector<std::array<double, 3>> weights(channels.size(), {0.0, 0.0, 0.0});
  std::array<double, 3> white{};
  for (int nm = first_nm; nm <= last_nm; ++nm) {
    const auto nearest = std::min_element(channels.begin(), channels.end(), [nm](const auto& a, const auto& b) {
      return std::fabs(1e3 * *a.wavelength_um - nm) < std::fabs(1e3 * *b.wavelength_um - nm);
    });
    const std::array<double, 3> rgb = rgb_of_xyz(observer_1931(nm));
    for (std::size_t k = 0; k < 3; ++k) {
      weights[static_cast<std::size_t>(nearest - channels.begin())][k] += rgb[k];
      white[k] += rgb[k];
    }
  }
  for (auto& w : weights) {
    for (std::size_t k = 0; k < 3; ++k) w[k] /= white[k];
  }
  return weights;
}

double luminance(const double* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

double bent(double x) {
  constexpr double straight = 0.75;
  if (x <= straight) return std::max(x, 0.0);
  return 1.0 - (1.0 - straight) * std::exp(-(x - straight) / (1.0 - straight));
}

}  // namespace

std::vector<std::array<double, 3>> rgb_weights(const std::vector<SceneChannel>& channels) {
  std::array<std::size_t, 3> place{};
  if (are_primaries(channels, place)) {
    std::vector<std::array<double, 3>> weights(3, {0.0, 0.0, 0.0});
    for (std::size_t k = 0; k < 3; ++k) weights[place[k]][k] = 1.0;
    return weights;
  }
  const bool spectral = channels.size() > 1 && std::all_of(channels.begin(), channels.end(), [](const SceneChannel& c) {
                          return c.wavelength_um.has_value();
                        });
  if (spectral) return spectral_weights(channels);
  const double part = 1.0 / static_cast<double>(channels.size());
  return std::vector<std::array<double, 3>>(channels.size(), {part, part, part});
}

std::vector<double> linear_rgb(const Picture& picture) {
  const auto weights = rgb_weights(picture.channels);
  const std::size_t pixels = picture.width * picture.height, channels = picture.channels.size();
  std::vector<double> rgb(3 * pixels, 0.0);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < 3; ++k) rgb[3 * i + k] += weights[c][k] * picture.radiance[i * channels + c];
    }
  }
  return rgb;
}

double automatic_exposure(const std::vector<double>& rgb) {
  std::vector<double> lit;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const double y = luminance(&rgb[i]);
    if (y > 0.0) lit.push_back(y);
  }
  if (lit.empty()) return 0.0;
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return std::log2(0.8 / *at);
}

RgbPicture for_screen(const Picture& picture, const std::vector<double>& rgb, double stops) {
  RgbPicture screen{picture.width, picture.height, std::vector<std::uint8_t>(rgb.size())};
  const double gain = std::exp2(stops);
  for (std::size_t i = 0; i < rgb.size(); ++i) screen.bytes[i] = srgb_byte(bent(gain * rgb[i]));
  return screen;
}

}  // namespace goniofit
