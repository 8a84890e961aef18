#include "render/scene_reader.h"

#include <algorithm>

#include "io/line_reader.h"
#include "io/material_io.h"
#include "render/scene_parts.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace scene_parts {

TomlValue required(const TomlValue& table, std::string_view key, const std::string& expected) {
  if (auto member = table.find(key)) return *member;
  throw key_error(table.source(), table.pointer() + pointer_step(key), "is missing, expected " + expected);
}

Vec3 read_vec3(const TomlValue& value) {
  std::vector<double> numbers;
  value.for_each_element("three numbers [x, y, z]", [&](const TomlValue& n) {
    const double number = n.number();
    n.require(std::fabs(number) <= 1e15, number, "a number within 1e15");  // squares and products stay finite
    numbers.push_back(number);
  });
  if (numbers.size() != 3) {
    value.fail("has " + std::to_string(numbers.size()) + " numbers, expected three [x, y, z]");
  }
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3 required_vec3(const TomlValue& table, std::string_view key) {
  return read_vec3(required(table, key, "three numbers [x, y, z]"));
}

void read_vec3(const TomlValue& table, std::string_view key, Vec3& result) {
  if (const auto member = table.find(key)) result = read_vec3(*member);
}

double required_number(const TomlValue& table, std::string_view key, const Range& range) {
  return goniofit::read_number(required(table, key, range.expected), range);
}

void read_number(const TomlValue& table, std::string_view key, const Range& range, double& result) {
  if (const auto member = table.find(key)) result = goniofit::read_number(*member, range);
}

Spectrum read_spectrum(const TomlValue& value, std::size_t channels) {
  const Range range = Range::closed(0.0, 1e30);
  if (!value.is_array()) return Spectrum(channels, goniofit::read_number(value, range));
  Spectrum spectrum;
  value.for_each_element("a number, or one a channel",
                         [&](const TomlValue& n) { spectrum.push_back(goniofit::read_number(n, range)); });
  if (spectrum.size() != channels) {
    value.fail("has " + std::to_string(spectrum.size()) + " numbers, expected one, or one for each of the " +
               std::to_string(channels) + " channels");
  }
  return spectrum;
}

std::filesystem::path read_path(const Scene& scene, const TomlValue& value) {
  const std::string& text = value.text("the path of a file");
  if (text.empty() || text.find('\0') != std::string::npos) value.fail("is empty, expected the path of a file");
  return (scene.source.parent_path() / text).lexically_normal();
}

}  // namespace scene_parts

namespace {

using namespace scene_parts;

constexpr std::size_t largest_file = std::size_t{1} << 20U;

void read_camera(const TomlValue& table, Camera& camera) {
  table.expect_keys({"position", "look_at", "up", "fov_deg"});
  camera.position = required_vec3(table, "position");
  camera.look_at = required_vec3(table, "look_at");
  read_vec3(table, "up", camera.up);
  scene_parts::read_number(table, "fov_deg", {1e-3, 179.0, true, true, "degrees from 0.001 to 179"}, camera.fov_deg);
}

template <class Integer>
void read_count(const TomlValue& table, std::string_view key, std::int64_t least, std::int64_t most, Integer& result) {
  const auto member = table.find(key);
  if (!member) return;
  const std::string expected = "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const std::int64_t value = member->whole_number(expected);
  if (value < least || value > most) member->fail("is " + std::to_string(value) + ", expected " + expected);
  result = static_cast<Integer>(value);
}

void read_image(const TomlValue& table, ImageSettings& image) {
  table.expect_keys({"width", "height", "samples", "max_bounces", "indirect", "path_limit", "seed", "exposure"});
  constexpr std::int64_t largest_side = 65536;
  read_count(table, "width", 1, largest_side, image.width);
  read_count(table, "height", 1, largest_side, image.height);
  read_count(table, "samples", 1, most_samples, image.samples);
  read_count(table, "max_bounces", 1, most_bounces, image.max_bounces);
  read_count(table, "seed", 0, std::numeric_limits<std::int64_t>::max(), image.seed);
  scene_parts::read_number(table, "indirect", {0.0, 1.0, false, true, "a number above 0 and up to 1"}, image.indirect);
  if (const auto limit = table.find("path_limit")) {
    image.path_limit = goniofit::read_number(*limit, Range::above(0.0));
  }
  const auto exposure = table.find("exposure");
  if (!exposure || (exposure->is_string() && exposure->text() == "auto")) return;
  if (!exposure->is_number()) exposure->fail_type("\"auto\" or a number of stops");
  image.exposure_stops = goniofit::read_number(*exposure, Range::closed(-60.0, 60.0));
}

std::vector<SceneChannel> channels_of(const Material& material) {
  std::vector<SceneChannel> channels;
  for (const MaterialChannel& c : material.channels) channels.push_back({c.name, c.wavelength_um});
  return channels;
}

Material lambertian(const std::string& name, const Spectrum& reflectance, const std::vector<SceneChannel>& channels) {
  Material material;
  material.name = name;
  material.components = {Effect::udf};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    MaterialChannel channel;
    channel.name = channels[c].name;
    channel.wavelength_um = channels[c].wavelength_um;
    channel.coefficient(Coefficient::k_udf) = reflectance[c];
    material.channels.push_back(channel);
  }
  return material;
}

// Those from files first: they say which channels there are.
void read_materials(const TomlValue& table, Scene& scene) {
  const std::string kinds = "file, the path of a material, or reflectance";
  table.for_each_member("a table of materials", [&](const std::string& name, const TomlValue& entry) {
    if (!entry.is_table()) entry.fail_type("a table of " + kinds);
    entry.expect_keys({"file", "reflectance"});
    const auto file = entry.find("file");
    if (file.has_value() == entry.find("reflectance").has_value()) entry.fail("expected one of " + kinds);
    if (!file) return;
    SceneMaterial material{name, read_path(scene, *file), {}};
    material.material = read_material(material.file);
    if (scene.channels.empty()) scene.channels = channels_of(material.material);
    scene.materials.push_back(std::move(material));
  });
  if (scene.channels.empty()) scene.channels = {{"R", 0.65}, {"G", 0.55}, {"B", 0.45}};
  table.for_each_member("a table of materials", [&](const std::string& name, const TomlValue& entry) {
    const auto reflectance = entry.find("reflectance");
    if (!reflectance) return;
    const Spectrum values = read_spectrum(*reflectance, scene.channels.size());
    for (const double value : values) reflectance->require(value <= 1.0, value, "a number in [0, 1]");
    scene.materials.push_back({name, {}, lambertian(name, values, scene.channels)});
  });
  if (scene.materials.empty()) table.fail("is empty, expected at least one material");
  std::sort(scene.materials.begin(), scene.materials.end(),
            [](const SceneMaterial& a, const SceneMaterial& b) { return a.name < b.name; });
}

void read_plan(const TomlValue& table, Scene& scene) {
  table.expect_keys({"tolerance"});
  const Range range{0.0, 1.0, false, false, "a number between 0 and 1"};
  if (const auto tolerance = table.find("tolerance")) scene.plan_tolerance = goniofit::read_number(*tolerance, range);
}

void read_parts(const TomlValue& document, Scene& scene) {
  document.expect_keys({"camera", "image", "plan", "materials", "objects", "lights"});
  read_camera(required(document, "camera", "a table of position and look_at"), scene.camera);
  if (const auto image = document.find("image")) read_image(*image, scene.image);
  if (const auto plan = document.find("plan")) read_plan(*plan, scene);
  read_materials(required(document, "materials", "at least one material"), scene);
  required(document, "objects", "at least one object")
      .for_each_element("an array of tables, [[objects]]", [&](const TomlValue& entry) { read_object(entry, scene); });
  required(document, "lights", "at least one light")
      .for_each_element("an array of tables, [[lights]]", [&](const TomlValue& entry) { read_light(entry, scene); });
}

}  // namespace

Scene parse_scene(std::string_view toml, const std::filesystem::path& source) {
  const std::string name = source.string();
  if (toml.size() > largest_file) throw input_error(name, 0, "", "is too large for a scene");
  const toml::table document = parse_toml(toml, name);
  Scene scene;
  scene.source = source;
  read_parts({document, name}, scene);
  validate(scene, name);
  return scene;
}

Scene read_scene(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return parse_scene(read_whole(in, path.string(), largest_file), path);
}

}  // namespace goniofit
