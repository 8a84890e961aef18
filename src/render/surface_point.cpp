// Where a ray meets a surface, and how that lies.

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "render/analytic.h"
#include "render/tracer_state.h"

namespace goniofit {

namespace {

struct Normals {
  Vec3 geometric, shading;
  bool two_sided;
};

Normals mesh_normals(const Mesh& mesh, std::uint32_t triangle, const Vec3& position) {
  const MeshTriangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t.vertex[0]], b = mesh.vertices[t.vertex[1]], c = mesh.vertices[t.vertex[2]];
  const Vec3 doubled = cross(b - a, c - a);
  const Vec3 flat = normalised(doubled);
  if (!t.normal) return {flat, flat, true};
  // Barycentric coordinates as ratios of areas.
  const double area2 = dot(doubled, doubled);
  const double v = dot(cross(position - a, c - a), doubled) / area2;
  const double w = dot(cross(b - a, position - a), doubled) / area2;
  const auto& n = *t.normal;
  const Vec3 mixed = (1.0 - v - w) * mesh.normals[n[0]] + v * mesh.normals[n[1]] + w * mesh.normals[n[2]];
  // What a file says of a triangle's normals may point away from its face, or cancel.
  if (!(dot(mixed, mixed) > 1e-12)) return {flat, flat, true};
  const Vec3 smooth = normalised(mixed);
  return {flat, dot(smooth, flat) < 0.0 ? -smooth : smooth, true};
}

Normals normals_at(const Object& object, const Ray& ray, const Hit& hit, const Vec3& position) {
  if (const auto* s = std::get_if<Sphere>(&object.shape)) {
    const Vec3 n = normalised(position - s->center);
    return {n, n, false};
  }
  if (const auto* p = std::get_if<Plane>(&object.shape)) {
    const Vec3 n = normalised(p->normal);
    return {n, n, true};
  }
  if (const auto* m = std::get_if<Mesh>(&object.shape)) return mesh_normals(*m, hit.triangle, position);
  const Cylinder& c = std::get<Cylinder>(object.shape);
  const auto met = analytic::cylinder(c, ray.origin, ray.direction, 0.0);
  const Vec3 n = met ? normalised(met->normal) : -ray.direction;
  return {n, n, !c.caps};
}

}  // namespace

SurfacePoint Tracer::surface_point(const Ray& ray, const Hit& hit) const {
  const Object& object = state_->objects[hit.surface];
  const Vec3 position = ray.origin + hit.distance * ray.direction;
  Normals n = normals_at(object, ray, hit, position);
  if (n.two_sided && dot(n.geometric, ray.direction) > 0.0) n = {-n.geometric, -n.shading, true};
  Frame frame = Frame::about(n.shading, object.tangent);
  if (object.brushed_deg != 0.0) {
    const double turn = radians(object.brushed_deg);
    frame = Frame::about(n.shading, frame.to_world(std::cos(turn), std::sin(turn), 0.0));
  }
  const double scale = std::max({largest_component(position), largest_component(ray.origin), hit.distance});
  return {position, n.geometric, frame, float_steps * scale};
}

}  // namespace goniofit
