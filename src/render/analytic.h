#pragma once
// Where rays meet shapes, in double precision: Embree finds which one is met, these say where. Directions are unit
// vectors.

#include <optional>

#include "scene.h"

namespace goniofit::analytic {

/// Distance to a sphere: where the ray comes in or, from inside, where it goes out. A ray that just misses meets it
/// where it comes nearest: whether it hits was decided before, in single precision.
[[nodiscard]] inline double sphere(const Sphere& s, const Vec3& origin, const Vec3& direction) noexcept {
  const Vec3 to = s.center - origin;
  const double along = dot(to, direction);
  // Not along² - (|to|² - r²): the foot of the perpendicular does not cancel where the sphere is far.
  const Vec3 foot = to - along * direction;
  const double half = std::sqrt(std::max(0.0, s.radius * s.radius - dot(foot, foot)));
  return along - half > 0.0 ? along - half : along + half;
}

/// Distance to a plane; infinite where the ray runs along it.
[[nodiscard]] inline double plane(const Vec3& point, const Vec3& normal, const Vec3& origin,
                                  const Vec3& direction) noexcept {
  return dot(point - origin, normal) / dot(direction, normal);
}

struct CylinderHit {
  double distance;
  Vec3 normal;  ///< outward
};
/// The nearest beyond `least`: side or caps, from outside or (where there are no caps) inside.
[[nodiscard]] std::optional<CylinderHit> cylinder(const Cylinder& c, const Vec3& origin, const Vec3& direction,
                                                  double least) noexcept;

}  // namespace goniofit::analytic
