#pragma once
// Which surface a ray meets first, and whether anything stands between two points: by Embree, in packets of 16 rays and
// single precision. Where exactly a surface is met is computed anew in double precision.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "scene.h"

namespace goniofit {

struct Ray {
  Vec3 origin;
  Vec3 direction;                                           ///< a unit vector
  double length = std::numeric_limits<double>::infinity();  ///< what lies beyond is not met
};

inline constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

struct Hit {
  /// An object of the scene; objects.size() + i is the light i, an area light; or `nothing`.
  std::uint32_t surface = nothing;
  std::uint32_t triangle = 0;  ///< of a mesh
  double distance = std::numeric_limits<double>::infinity();
};

/// The surface there, of unit vectors.
struct SurfacePoint {
  Vec3 position;
  Vec3 normal;       ///< geometric; flat shapes and meshes turn it to where the ray came from
  Frame shading;     ///< z is the shading normal, on the same side; x is azimuth 0 of the material
  double clearance;  ///< how far along the normal a ray starts so as not to meet the surface again
};

class Tracer {
 public:
  /// Keeps no reference to the scene. Throws Error (system) where Embree fails.
  explicit Tracer(const Scene& scene);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  /// hits[i] of rays[i]. `coherent`: neighbours go alike. Safe to call from several threads.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const;
  /// blocked[i] is 1 where anything is met within the ray's length, else 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, bool coherent) const;

  /// Of a hit on an object.
  [[nodiscard]] SurfacePoint surface_point(const Ray& ray, const Hit& hit) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace goniofit
