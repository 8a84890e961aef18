// The [[lights]] of a scene.

#include <algorithm>

#include "io/number.h"
#include "render/exr_image.h"
#include "render/scene_parts.h"
#include "render/spectral_exr.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::scene_parts {

namespace {

Range sizes() { return {0.0, 1e15, false, true, "a number above 0 and up to 1e15"}; }
Range sizes_or_none() { return {0.0, 1e15, true, true, "a number from 0 to 1e15"}; }

Spectrum required_spectrum(const TomlValue& table, std::string_view key, const Scene& scene) {
  return read_spectrum(required(table, key, "a number, or one a channel"), scene.channels.size());
}

Light read_point(const TomlValue& table, const Scene& scene) {
  table.expect_keys({"type", "position", "intensity", "radius"});
  PointLight light{required_vec3(table, "position"), required_spectrum(table, "intensity", scene)};
  scene_parts::read_number(table, "radius", sizes_or_none(), light.radius);
  return light;
}

Light read_directional(const TomlValue& table, const Scene& scene) {
  table.expect_keys({"type", "direction", "irradiance", "diameter_deg"});
  DirectionalLight light{required_vec3(table, "direction"), required_spectrum(table, "irradiance", scene)};
  scene_parts::read_number(table, "diameter_deg", {0.0, 180.0, true, false, "degrees from 0 to below 180"},
                           light.diameter_deg);
  return light;
}

Light read_area(const TomlValue& table, const Scene& scene) {
  table.expect_keys({"type", "radiance", "shape", "center", "u", "v", "normal", "radius"});
  const TomlValue shape = required(table, "shape", "rectangle, disc or sphere");
  AreaLight light{Sphere{}, required_spectrum(table, "radiance", scene)};
  const std::string& name = shape.text();
  if (name == "rectangle") {
    table.expect_keys({"type", "radiance", "shape", "center", "u", "v"});
    light.shape = Rectangle{required_vec3(table, "center"), required_vec3(table, "u"), required_vec3(table, "v")};
  } else if (name == "disc") {
    table.expect_keys({"type", "radiance", "shape", "center", "normal", "radius"});
    light.shape =
        Disc{required_vec3(table, "center"), required_vec3(table, "normal"), required_number(table, "radius", sizes())};
  } else if (name == "sphere") {
    table.expect_keys({"type", "radiance", "shape", "center", "radius"});
    light.shape = Sphere{required_vec3(table, "center"), required_number(table, "radius", sizes())};
  } else {
    shape.fail(in_quotes(name) + " is not known, expected rectangle, disc or sphere");
  }
  return light;
}

Light read_environment(const TomlValue& table, const Scene& scene) {
  table.expect_keys({"type", "radiance", "file", "scale", "rotation_deg"});
  EnvironmentLight light;
  const auto file = table.find("file");
  if (file.has_value() == table.find("radiance").has_value()) table.fail("expected one of radiance and file");
  if (!file) {
    table.expect_keys({"type", "radiance"});
    light.radiance = required_spectrum(table, "radiance", scene);
    return light;
  }
  light.map = std::make_shared<const EnvironmentMap>(read_environment_map(read_path(scene, *file), scene.channels));
  const auto scale = table.find("scale");
  light.radiance = scale ? read_spectrum(*scale, scene.channels.size()) : Spectrum(scene.channels.size(), 1.0);
  scene_parts::read_number(table, "rotation_deg", Range::closed(-360.0, 360.0), light.rotation_deg);
  return light;
}

// Where the map has the scene's channel: null where it has not.
const std::vector<float>* find_channel(const ExrImage& image, const SceneChannel& channel) {
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    if (lower_case(image.channels[c]) == lower_case(channel.name)) return &image.values[c];
    const std::optional<double> nm = spectral_band_nm(image.channels[c]);
    constexpr double within_nm = 0.5;
    if (nm && channel.wavelength_um && std::fabs(*nm - 1e3 * *channel.wavelength_um) <= within_nm)
      return &image.values[c];
  }
  return image.channels.size() == 1 ? &image.values.front() : nullptr;
}

}  // namespace

EnvironmentMap read_environment_map(const std::filesystem::path& path, const std::vector<SceneChannel>& channels) {
  const ExrImage image = read_exr_image(path);
  EnvironmentMap map{path, image.width, image.height,
                     std::vector<double>(image.width * image.height * channels.size())};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::vector<float>* values = find_channel(image, channels[c]);
    if (values == nullptr) {
      throw input_error(
          path.string(), 0, "",
          "has no channel " + in_quotes(channels[c].name) + ", expected those of the scene's materials, or one alone");
    }
    for (std::size_t i = 0; i < values->size(); ++i) {
      if (!((*values)[i] >= 0.0F)) {
        throw input_error(
            path.string(), 0, "",
            "has a negative value in channel " + in_quotes(channels[c].name) + ", expected radiances of at least 0");
      }
      map.values[i * channels.size() + c] = static_cast<double>((*values)[i]);
    }
  }
  return map;
}

void read_light(const TomlValue& table, Scene& scene) {
  if (!table.is_table()) table.fail_type("a table");
  const TomlValue type = required(table, "type", "point, directional, area or environment");
  const std::string& name = type.text();
  if (name == "point") {
    scene.lights.push_back(read_point(table, scene));
  } else if (name == "directional") {
    scene.lights.push_back(read_directional(table, scene));
  } else if (name == "area") {
    scene.lights.push_back(read_area(table, scene));
  } else if (name == "environment") {
    scene.lights.push_back(read_environment(table, scene));
  } else {
    type.fail(in_quotes(name) + " is not known, expected point, directional, area or environment");
  }
}

}  // namespace goniofit::scene_parts
