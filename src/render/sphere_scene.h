#pragma once
// A material on a sphere under one light, as papers show it.

#include "scene.h"

namespace goniofit {

struct SphereSettings {
  std::size_t size = 256;  ///< pixels of the square picture
  /// Between the directions from the sphere to the eye and to the light: 0 lights from the eye, 90 from the upper left,
  /// beyond it from behind, where surfaces are met and seen at grazing.
  double light_angle_deg = 45.0;
  double sky = 0.0;  ///< radiance of all that surrounds the sphere
  std::size_t samples = 16;
  std::uint64_t seed = 1;
};

/// A unit sphere that fills nine tenths of the picture, seen from afar, and a point light whose irradiance where it
/// falls straight on the sphere is pi: Lambert's law of reflectance 1 has radiance 1 there. The light has a small size,
/// so that a mirror shows it. Direct light alone.
[[nodiscard]] Scene sphere_scene(const Material& material, const SphereSettings& settings = {});

}  // namespace goniofit
