#include "report/sphere_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "brdf/batch_evaluator.h"
#include "geometry/angles.h"
#include "geometry/direction.h"
#include "geometry/direction_batch.h"
#include "io/png_file.h"

namespace goniofit {
namespace {

using Color = std::array<double, 3>;

constexpr std::size_t samples_a_side = 3;  // of a pixel
constexpr double radius = 0.94;            // of half the picture
constexpr double background = 0.42;        // linear
constexpr double exposed_part = 0.9, exposed_to = 0.8;

Direction unit(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

Direction cross(const Direction& a, const Direction& b) {
  return unit(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// Of a point of the sphere: N and, along the meridian, the surface's x axis.
struct Frame {
  Direction x, y, n;
  explicit Frame(const Direction& normal) : n(normal) {
    const Direction up{0.0, 1.0, 0.0};
    y = std::fabs(n.y) < 1.0 ? cross(n, up) : Direction{1.0, 0.0, 0.0};
    x = cross(y, n);
  }
  [[nodiscard]] Direction seen(const Direction& d) const { return {dot(d, x), dot(d, y), dot(d, n)}; }
};

// A sample of the picture that the light reaches.
struct LitSample {
  std::size_t pixel;
  double cos_i;
};

struct Samples {
  DirectionBatch directions;
  std::vector<LitSample> lit;
  std::vector<double> covered;  ///< part of each pixel that is sphere
};

Samples sample_sphere(std::size_t size) {
  const Direction light = unit(-0.55, 0.6, 0.85);
  const Direction viewer{0.0, 0.0, 1.0};
  Samples out;
  out.covered.assign(size * size, 0.0);
  const auto at = [size](std::size_t i) {
    const auto count = static_cast<double>(size * samples_a_side);
    return (2.0 * (static_cast<double>(i) + 0.5) / count - 1.0) / radius;
  };
  for (std::size_t i = 0; i < size * samples_a_side; ++i) {
    for (std::size_t j = 0; j < size * samples_a_side; ++j) {
      const double x = at(j);
      const double y = -at(i);
      const double z2 = 1.0 - x * x - y * y;
      if (z2 <= 0.0) continue;
      const std::size_t pixel = i / samples_a_side * size + j / samples_a_side;
      out.covered[pixel] += 1.0 / static_cast<double>(samples_a_side * samples_a_side);
      const Direction normal{x, y, std::sqrt(z2)};
      const double cos_i = dot(normal, light);
      if (cos_i <= 0.0) continue;
      const Frame frame(normal);
      out.directions.push_back(frame.seen(light), frame.seen(viewer));
      out.lit.push_back({pixel, cos_i});
    }
  }
  return out;
}

// Of the brightest primary: by luminance a deep red would lose its shading to clipping.
double brightness(const Color& c) { return std::max({c[0], c[1], c[2]}); }

// What the brightness is set by.
double exposure_reference(std::vector<double> lit) {
  std::erase_if(lit, [](double y) { return !(y > 0.0); });
  // Longer exposures than forty of white's would show what nobody measures.
  constexpr double least = 1.0 / (40.0 * pi);
  if (lit.empty()) return least;
  const auto at = lit.begin() + static_cast<std::ptrdiff_t>(exposed_part * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return std::max(*at, least);
}

// One material channel a colour; f cos(theta_i), the mean over each pixel.
std::vector<Color> radiances(const Material& material, const PictureBands& bands, const Samples& samples,
                             std::size_t pixels) {
  Material drawn = quickly_drawn(material);
  drawn.fit.reset();
  drawn.channels.clear();
  std::vector<std::size_t> used(bands.channel.begin(), bands.channel.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::size_t c : used) drawn.channels.push_back(material.channels[c]);
  std::vector<double> values(used.size() * samples.directions.size());
  BatchEvaluator<double>(drawn, {.tolerance = 1e-4}).values(samples.directions, values);
  std::vector<Color> out(pixels, Color{});
  constexpr auto part = 1.0 / static_cast<double>(samples_a_side * samples_a_side);
  // A value beyond this is a mirror's; white is white.
  constexpr double most = 1e6;
  for (std::size_t s = 0; s < samples.lit.size(); ++s) {
    const auto [pixel, cos_i] = samples.lit[s];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t of = used.size() == 1 ? 0 : c;
      out[pixel][c] += part * cos_i * std::min(values[of * samples.lit.size() + s], most);
    }
  }
  return out;
}

bool same_name(const std::string& a, char letter) {
  return a.size() == 1 && (a[0] == letter || a[0] == static_cast<char>(letter + ('a' - 'A')));
}

std::optional<std::array<std::size_t, 3>> named_rgb(const Material& material) {
  std::array<std::size_t, 3> found{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < material.channels.size(); ++c) {
      if (!same_name(material.channels[c].name, "RGB"[k])) continue;
      found[k] = c;
      ++count;
      break;
    }
  }
  return count == 3 ? std::optional(found) : std::nullopt;
}

// The channels nearest to three wavelengths of the eye; nullopt unless they are three and near.
std::optional<std::array<std::size_t, 3>> visible_rgb(const Material& material) {
  constexpr std::array targets_um{0.61, 0.55, 0.46};
  constexpr double near_um = 0.06;
  std::array<std::size_t, 3> found{};
  for (std::size_t k = 0; k < 3; ++k) {
    double least = near_um;
    for (std::size_t c = 0; c < material.channels.size(); ++c) {
      const auto& wavelength = material.channels[c].wavelength_um;
      if (!wavelength || std::fabs(*wavelength - targets_um[k]) >= least) continue;
      least = std::fabs(*wavelength - targets_um[k]);
      found[k] = c;
    }
    if (least == near_um) return std::nullopt;
  }
  const bool distinct = found[0] != found[1] && found[1] != found[2] && found[0] != found[2];
  return distinct ? std::optional(found) : std::nullopt;
}

}  // namespace

PictureBands picture_bands(const Material& material) {
  const auto name = [&](std::size_t c) { return material.channels[c].name; };
  if (const auto rgb = named_rgb(material)) return {*rgb, "channels R, G, B"};
  if (const auto rgb = visible_rgb(material)) {
    return {*rgb,
            fmt::format("{}, {} and {} as red, green and blue", name((*rgb)[0]), name((*rgb)[1]), name((*rgb)[2]))};
  }
  const std::size_t middle = material.channels.size() / 2;
  return {{middle, middle, middle}, name(middle) + " as grey"};
}

Material quickly_drawn(Material material) {
  if (material.terms.distribution == DistributionTier::he_torrance_series) {
    material.terms.distribution = DistributionTier::he_torrance;
  }
  if (material.forms.rough == RoughForm::integral) material.forms.rough = RoughForm::functional;
  return material;
}

SpherePicture sphere_picture(const Material& material, std::size_t size) {
  SpherePicture out;
  out.size = size;
  out.bands = picture_bands(material);
  const Samples samples = sample_sphere(size);
  std::vector<Color> image = radiances(material, out.bands, samples, size * size);
  std::vector<double> lit;
  for (const Color& c : image) lit.push_back(brightness(c));
  const double highest = *std::max_element(lit.begin(), lit.end());
  const double reference = exposure_reference(std::move(lit));
  const double scale = exposed_to / reference;
  out.exposure = scale / pi;  // the white diffuser's radiance is 1/pi
  // Below full white only what exceeds it by less than this keeps its shading; a mirror's highlight is a white spot.
  const double burnt = std::clamp(scale * highest, 1.0, 12.0);
  out.rgb.reserve(3 * image.size());
  for (std::size_t p = 0; p < image.size(); ++p) {
    const double y = scale * brightness(image[p]);
    const double toned = (1.0 + y / (burnt * burnt)) / (1.0 + y) * scale;
    for (const double c : image[p]) {
      out.rgb.push_back(srgb_byte(toned * c + (1.0 - samples.covered[p]) * background));
    }
  }
  return out;
}

}  // namespace goniofit
