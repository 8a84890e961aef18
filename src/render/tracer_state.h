#pragma once
// What a Tracer holds: the scene as Embree has it, and as it is. Private to it.

#include <embree3/rtcore.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "tracer.h"

namespace goniofit {

/// How many units of single precision a ray starts off its surface, and ends before its target.
inline constexpr double float_steps = 32.0 * std::numeric_limits<float>::epsilon();

struct Tracer::State {
  /// Planes without end have no box for Embree: they are met apart.
  struct EndlessPlane {
    Vec3 point, normal;
    std::uint32_t surface;
  };
  /// One geometry of Embree holds all shapes of a kind; this says whose its primitives are.
  struct Group {
    std::vector<std::uint32_t> surface{};  ///< by primitive; of a mesh: the one it is
    bool mesh = false;
  };

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Group> groups;  ///< by geometry
  std::vector<EndlessPlane> planes;
  std::vector<Cylinder> cylinders;
  std::vector<Object> objects;
  std::vector<std::optional<AreaLight>> lights;

  explicit State(const Scene& scene);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  State(State&&) = delete;
  State& operator=(State&&) = delete;

  /// Distance along the ray to a surface that Embree says it meets, in double precision.
  [[nodiscard]] double distance(const Ray& ray, std::uint32_t surface, std::uint32_t triangle) const;

 private:
  State() = default;
  template <class Shape>
  using Owned = std::vector<std::pair<Shape, std::uint32_t>>;  // with the surface that it is

  void build();
  void check(const char* doing) const;
  template <class T>
  T* buffer(RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t items) const;
  void attach(RTCGeometry g, Group group);
  void attach_spheres(const Owned<Sphere>& spheres);
  void attach_quads(const Owned<Rectangle>& quads);
  void attach_discs(const Owned<Disc>& discs);
  void attach_cylinders(std::vector<std::uint32_t> surfaces);
  void attach_mesh(const Mesh& mesh, std::uint32_t surface);
};

}  // namespace goniofit
