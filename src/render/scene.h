#pragma once
// What is rendered: a camera, objects with materials, lights. Lengths in one unit of the user's choice, z up by custom;
// spectra have one number a channel, in the order of the materials' channels.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../brdf/batch_evaluator.h"
#include "../brdf/material.h"
#include "vec3.h"

namespace goniofit {

/// One number a channel.
using Spectrum = std::vector<double>;

/// A pinhole.
struct Camera {
  Vec3 position{0.0, -5.0, 1.0};
  Vec3 look_at{};
  Vec3 up{0.0, 0.0, 1.0};
  double fov_deg = 40.0;  ///< of the image's height, above 0 and below 180
};

struct ImageSettings {
  std::size_t width = 512, height = 512;
  std::size_t samples = 16;  ///< a pixel; 1 is the pixel's centre, more are stratified over it
  int max_bounces = 3;       ///< reflections of one light path; 1 is direct light alone
  /// Part of the camera's hits from which a path goes on by a wide effect (all but dd and fs), weighted for the others:
  /// what comes by way of other surfaces needs fewer samples than what comes straight from lights.
  double indirect = 1.0;
  /// Largest radiance that a single path may bring by way of another surface; null: any, which is right in the mean. A
  /// limit loses part of what narrow lobes focus on other surfaces, whose rare bright paths are seen as sparks.
  std::optional<double> path_limit{};
  std::uint64_t seed = 1;
  std::optional<double> exposure_stops{};  ///< of the PNG; null: by the image itself
};
inline constexpr std::size_t most_pixels = std::size_t{1} << 26U;
inline constexpr std::size_t most_samples = std::size_t{1} << 16U;
inline constexpr int most_bounces = 64;

/// A material and how it is evaluated: what a plan may put in place of the scene's own.
struct RenderMaterial {
  Material material;
  CompileSettings compile{};
  bool single_precision = false;
  bool follows = true;  ///< the light that other surfaces send to it; else that of lights alone
};

struct SceneMaterial {
  std::string name;              ///< in the scene
  std::filesystem::path file{};  ///< empty where the scene itself has it
  Material material;
};

// ---- shapes. Spheres and cylinders are seen from outside; flat ones and meshes reflect on the side that is seen.

struct Sphere {
  Vec3 center{};
  double radius = 1.0;
};
/// Infinite, or a square of sides 2 half_size about `point`, whose sides lie along Frame::about(normal, tangent).
struct Plane {
  Vec3 point{};
  Vec3 normal{0.0, 0.0, 1.0};  ///< of any length
  std::optional<double> half_size{};
};
struct Cylinder {
  Vec3 base{}, top{0.0, 0.0, 1.0};  ///< centres of its ends
  double radius = 1.0;
  bool caps = true;
};
struct MeshTriangle {
  std::array<std::uint32_t, 3> vertex{};
  std::optional<std::array<std::uint32_t, 3>> normal{};  ///< where the file has shading normals
};
/// In the scene's coordinates: scale, rotation and translation are done.
struct Mesh {
  std::filesystem::path file{};
  std::vector<Vec3> vertices{};
  std::vector<Vec3> normals{};  ///< unit vectors
  std::vector<MeshTriangle> triangles{};
};
using Shape = std::variant<Sphere, Plane, Cylinder, Mesh>;

struct Object {
  Shape shape;
  std::size_t material = 0;  ///< index into Scene::materials
  /// The surface's azimuth 0 is this direction, projected on the surface and turned by brushed_deg about the normal.
  Vec3 tangent{1.0, 0.0, 0.0};
  double brushed_deg = 0.0;
};

// ---- lights

/// Lights as a point, whatever its radius; its radius is what a mirror (coh) or the camera sees: a disc of radiance
/// intensity / (pi radius²), turned to whoever looks. Without one no mirror shows it.
struct PointLight {
  Vec3 position{};
  Spectrum intensity;  ///< W/sr
  double radius = 0.0;
};
/// Lights as a parallel beam; its diameter is what a mirror or the camera sees, as of the point light.
struct DirectionalLight {
  Vec3 direction{0.0, 0.0, -1.0};  ///< in which the light travels; of any length
  Spectrum irradiance;             ///< W/m² on a surface facing it
  double diameter_deg = 0.0;
};
/// |u| and |v| are half the sides; it shines towards u x v.
struct Rectangle {
  Vec3 center{}, u{}, v{};
};
/// Shines towards its normal.
struct Disc {
  Vec3 center{};
  Vec3 normal{0.0, 0.0, -1.0};
  double radius = 1.0;
};
/// Black but for what it emits; a part of the scene that is seen and shades.
struct AreaLight {
  std::variant<Rectangle, Disc, Sphere> shape;
  Spectrum radiance;  ///< W/(m² sr)
};
/// Latitude and longitude: rows from +z down to -z at equal steps of the polar angle, columns at equal steps of azimuth
/// about z, the first at `rotation_deg`, counterclockwise as seen from above.
struct EnvironmentMap {
  std::filesystem::path file{};
  std::size_t width = 0, height = 0;
  std::vector<double> values;  ///< [(row * width + column) * channels + channel]
};
/// Surrounds the scene: one radiance, or a map's times it.
struct EnvironmentLight {
  Spectrum radiance;
  std::shared_ptr<const EnvironmentMap> map{};
  double rotation_deg = 0.0;
};
using Light = std::variant<PointLight, DirectionalLight, AreaLight, EnvironmentLight>;

struct SceneChannel {
  std::string name;
  std::optional<double> wavelength_um{};
  friend bool operator==(const SceneChannel&, const SceneChannel&) = default;
};

struct Scene {
  std::filesystem::path source{};
  Camera camera;
  ImageSettings image;
  std::optional<double> plan_tolerance{};  ///< of the image, where the scene asks for a plan
  std::vector<SceneChannel> channels;      ///< those of every material
  std::vector<SceneMaterial> materials;
  std::vector<Object> objects;
  std::vector<Light> lights;
};

/// Throws Error (bad_input) as "FILE: /objects/2/radius: ..." for what cannot be rendered: numbers that are not finite
/// or out of range, no objects, no light that shines, a camera that looks nowhere or stands inside an object, materials
/// whose channels differ or that are not valid. `where` is the file it came from.
void validate(const Scene& scene, const std::string& where);

/// Whether a mirror (coh) can show the light: it has a size.
[[nodiscard]] bool mirror_shows(const Light& light) noexcept;
/// Whether nothing of it shines.
[[nodiscard]] bool is_dark(const Light& light) noexcept;

/// The scene's materials, each as it is.
[[nodiscard]] std::vector<RenderMaterial> given_materials(const Scene& scene);

}  // namespace goniofit
