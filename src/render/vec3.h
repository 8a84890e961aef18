#pragma once
// Points and directions of a scene, in its own lengths.

#include <algorithm>
#include <cmath>

namespace goniofit {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr Vec3 operator+(const Vec3& a, const Vec3& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a, const Vec3& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a) noexcept { return {-a.x, -a.y, -a.z}; }
[[nodiscard]] constexpr Vec3 operator*(double s, const Vec3& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double length(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }
/// Not defined for the zero vector.
[[nodiscard]] inline Vec3 normalised(const Vec3& a) noexcept { return (1.0 / length(a)) * a; }
[[nodiscard]] inline double largest_component(const Vec3& a) noexcept {
  return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
}

/// Right-handed, of unit vectors.
struct Frame {
  Vec3 x, y, z;

  /// z along `normal` (a unit vector), x as near to `tangent` as it can be; any x where they are parallel.
  [[nodiscard]] static Frame about(const Vec3& normal, const Vec3& tangent) noexcept {
    Vec3 x = tangent - dot(tangent, normal) * normal;
    if (!(dot(x, x) > 1e-16 * dot(tangent, tangent))) {
      const Vec3 other = std::fabs(normal.x) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
      x = other - dot(other, normal) * normal;
    }
    x = normalised(x);
    return {x, cross(normal, x), normal};
  }
  [[nodiscard]] Vec3 to_world(double a, double b, double c) const noexcept { return a * x + b * y + c * z; }
};

}  // namespace goniofit
