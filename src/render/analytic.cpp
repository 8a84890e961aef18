#include "render/analytic.h"

#include <array>

namespace goniofit::analytic {

namespace {

// The side: |w + t d|² = r² of the parts across the axis.
void meet_side(const Cylinder& c, const Vec3& axis, double height, const Vec3& to, const Vec3& direction, double least,
               std::optional<CylinderHit>& nearest) noexcept {
  const Vec3 d = direction - dot(direction, axis) * axis;
  const Vec3 w = to - dot(to, axis) * axis;
  const double a = dot(d, d);
  if (!(a > 0.0)) return;
  const double middle = -dot(w, d) / a;
  const Vec3 foot = w + middle * d;
  const double square = (c.radius * c.radius - dot(foot, foot)) / a;
  if (!(square >= 0.0)) return;
  const double half = std::sqrt(square);
  for (const double t : {middle - half, middle + half}) {
    const Vec3 place = to + t * direction;
    const double along = dot(place, axis);
    if (t <= least || along < 0.0 || along > height || (nearest && nearest->distance <= t)) continue;
    nearest = {t, (1.0 / c.radius) * (place - along * axis)};
  }
}

void meet_cap(const Cylinder& c, const Vec3& center, const Vec3& normal, const Vec3& origin, const Vec3& direction,
              double least, std::optional<CylinderHit>& nearest) noexcept {
  const double t = plane(center, normal, origin, direction);
  if (!(t > least) || (nearest && nearest->distance <= t)) return;
  if (length(origin + t * direction - center) <= c.radius) nearest = {t, normal};
}

}  // namespace

std::optional<CylinderHit> cylinder(const Cylinder& c, const Vec3& origin, const Vec3& direction,
                                    double least) noexcept {
  const double height = length(c.top - c.base);
  const Vec3 axis = (1.0 / height) * (c.top - c.base);
  std::optional<CylinderHit> nearest;
  meet_side(c, axis, height, origin - c.base, direction, least, nearest);
  if (c.caps) {
    meet_cap(c, c.base, -axis, origin, direction, least, nearest);
    meet_cap(c, c.top, axis, origin, direction, least, nearest);
  }
  return nearest;
}

}  // namespace goniofit::analytic
