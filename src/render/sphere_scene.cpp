#include "render/sphere_scene.h"

#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

Scene sphere_scene(const Material& material, const SphereSettings& settings) {
  constexpr double eye_distance = 20.0;
  constexpr double light_distance = 40.0;  // from the centre, beyond the eye: which would see it otherwise
  Scene scene;
  for (const MaterialChannel& c : material.channels) scene.channels.push_back({c.name, c.wavelength_um});
  scene.materials.push_back({"sphere", {}, material});
  scene.objects.push_back({Sphere{}, 0});
  scene.camera.position = {0.0, -eye_distance, 0.0};
  scene.camera.look_at = {};
  // The limb is seen at asin(1 / distance).
  scene.camera.fov_deg = 2.0 * degrees(std::atan(std::tan(std::asin(1.0 / eye_distance)) / 0.9));
  // To the upper left of the line to the eye.
  const double angle = radians(settings.light_angle_deg);
  const double aside = std::sin(angle) * std::sqrt(0.5);
  PointLight light;
  light.position = light_distance * Vec3{-aside, -std::cos(angle), aside};
  const double to_surface = light_distance - 1.0;
  light.intensity.assign(scene.channels.size(), pi * to_surface * to_surface);
  light.radius = 1.0;
  scene.lights.emplace_back(light);
  if (settings.sky > 0.0) scene.lights.emplace_back(EnvironmentLight{Spectrum(scene.channels.size(), settings.sky)});
  scene.image.width = scene.image.height = settings.size;
  scene.image.samples = settings.samples;
  scene.image.seed = settings.seed;
  scene.image.max_bounces = 1;
  return scene;
}

}  // namespace goniofit
