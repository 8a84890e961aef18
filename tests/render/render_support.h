#pragma once
// Scenes that tests share.

#include <cmath>
#include <string>
#include <vector>

#include "geometry/direction.h"
#include "render/renderer.h"
#include "support/materials.h"

namespace goniofit::test {

inline Material lambertian(double reflectance) {
  Material m;
  m.name = "lambert";
  m.components = {Effect::udf};
  m.channels = {channel("R", 0.65, 1.5, 0.0, 0.0, reflectance, 0.0, 0.0)};
  return m;
}

/// One channel of a material.
inline Material single_channel(Material m, std::size_t c = 0) {
  m.channels = {m.channels[c]};
  m.fit.reset();
  return m;
}

/// One material, no objects or lights yet.
inline Scene scene_of(const Material& material) {
  Scene scene;
  for (const MaterialChannel& c : material.channels) scene.channels.push_back({c.name, c.wavelength_um});
  scene.materials.push_back({"material", {}, material});
  return scene;
}

inline Spectrum flat(const Scene& scene, double value) { return Spectrum(scene.channels.size(), value); }

/// An endless floor z = 0, its origin looked at from theta and azimuth phi through 8 x 8 pixels, which are so small
/// that all see the same point: 64 independent trials of one radiance.
inline Scene floor_scene(const Material& material, double theta_deg, double phi_deg = 0.0, std::size_t samples = 64) {
  Scene scene = scene_of(material);
  scene.objects.push_back({Plane{}, 0});
  const Direction v = direction_of(theta_deg, phi_deg);
  scene.camera.position = {3.0 * v.x, 3.0 * v.y, 3.0 * v.z};
  scene.camera.look_at = {};
  scene.camera.up = theta_deg < 1.0 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 0.0, 1.0};
  scene.camera.fov_deg = 1e-6;
  scene.image.width = scene.image.height = 8;
  scene.image.samples = samples;
  scene.image.max_bounces = 1;
  return scene;
}

inline Rendering rendered(const Scene& scene, const RenderSettings& settings = {}) {
  return render(scene, given_materials(scene), settings);
}

struct Estimate {
  double mean, standard_error;
};
/// Over pixels, of one channel.
inline Estimate estimate(const Picture& picture, std::size_t channel = 0) {
  const std::size_t channels = picture.channels.size(), n = picture.radiance.size() / channels;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += picture.radiance[i * channels + channel];
  const double mean = sum / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(picture.radiance[i * channels + channel] - mean, 2);
  return {mean, std::sqrt(squares / static_cast<double>(n) / static_cast<double>(n - 1))};
}

}  // namespace goniofit::test
