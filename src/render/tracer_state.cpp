// The scene as Embree has it.

#include "render/tracer_state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/analytic.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr float beyond_all = std::numeric_limits<float>::infinity();

float as_float(double x) { return static_cast<float>(x); }

// The smallest box of floats around a box of doubles.
RTCBounds bounds_of(const Cylinder& c) {
  const double margin =
      c.radius + float_steps * (c.radius + std::max(largest_component(c.base), largest_component(c.top)));
  const auto low = [margin](double a, double b) { return as_float(std::min(a, b) - margin); };
  const auto high = [margin](double a, double b) { return as_float(std::max(a, b) + margin); };
  return {low(c.base.x, c.top.x),  low(c.base.y, c.top.y),  low(c.base.z, c.top.z),  0.0F,
          high(c.base.x, c.top.x), high(c.base.y, c.top.y), high(c.base.z, c.top.z), 0.0F};
}

void cylinder_bounds(const RTCBoundsFunctionArguments* a) {
  *a->bounds_o = bounds_of((*static_cast<const std::vector<Cylinder>*>(a->geometryUserPtr))[a->primID]);
}

std::optional<double> meet_cylinder(const void* cylinders, unsigned which, RTCRayN* rays, unsigned n, unsigned i) {
  const Cylinder& c = (*static_cast<const std::vector<Cylinder>*>(cylinders))[which];
  const Vec3 origin{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
  const Vec3 direction{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  const auto hit = analytic::cylinder(c, origin, direction, RTCRayN_tnear(rays, n, i));
  if (!hit || hit->distance >= static_cast<double>(RTCRayN_tfar(rays, n, i))) return std::nullopt;
  return hit->distance;
}

void intersect_cylinder(const RTCIntersectFunctionNArguments* a) {
  RTCRayN* const rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* const hits = RTCRayHitN_HitN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    const auto distance = meet_cylinder(a->geometryUserPtr, a->primID, rays, a->N, i);
    if (!distance) continue;
    RTCRayN_tfar(rays, a->N, i) = as_float(*distance);
    RTCHitN_geomID(hits, a->N, i) = a->geomID;
    RTCHitN_primID(hits, a->N, i) = a->primID;
  }
}

void occlude_cylinder(const RTCOccludedFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    if (meet_cylinder(a->geometryUserPtr, a->primID, a->ray, a->N, i)) RTCRayN_tfar(a->ray, a->N, i) = -beyond_all;
  }
}

double distance_to(const std::variant<Rectangle, Disc, Sphere>& shape, const Ray& ray) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return analytic::sphere(*s, ray.origin, ray.direction);
  if (const auto* d = std::get_if<Disc>(&shape)) {
    return analytic::plane(d->center, d->normal, ray.origin, ray.direction);
  }
  const Rectangle& r = std::get<Rectangle>(shape);
  return analytic::plane(r.center, cross(r.u, r.v), ray.origin, ray.direction);
}

}  // namespace

// By way of another constructor, so that the destructor runs where this one throws.
Tracer::State::State(const Scene& from) : State() {
  objects = from.objects;
  for (const Light& light : from.lights) {
    const auto* area = std::get_if<AreaLight>(&light);
    lights.push_back(area == nullptr ? std::nullopt : std::optional(*area));
  }
  device = rtcNewDevice("threads=1");
  if (device == nullptr) throw system_error("Embree does not start on this machine");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  build();
}

Tracer::State::~State() {
  if (scene != nullptr) rtcReleaseScene(scene);
  if (device != nullptr) rtcReleaseDevice(device);
}

void Tracer::State::check(const char* doing) const {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw system_error(std::string("out of memory ") + doing);
  if (error != RTC_ERROR_NONE) {
    throw system_error(std::string("Embree failed ") + doing + ": error " + std::to_string(static_cast<int>(error)));
  }
}

template <class T>
T* Tracer::State::buffer(RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t items) const {
  void* const data = rtcSetNewGeometryBuffer(g, type, 0, format, sizeof(T), items);
  if (data == nullptr) {
    rtcReleaseGeometry(g);
    check("taking memory for a scene");
    throw system_error("Embree failed taking memory for a scene");
  }
  return static_cast<T*>(data);
}

void Tracer::State::attach(RTCGeometry g, Group group) {
  rtcCommitGeometry(g);
  const unsigned id = rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
  if (groups.size() <= id) groups.resize(id + 1);
  groups[id] = std::move(group);
}

void Tracer::State::attach_spheres(const Owned<Sphere>& spheres) {
  if (spheres.empty()) return;
  const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* const at = buffer<std::array<float, 4>>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres.size());
  Group group;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i].first;
    at[i] = {as_float(s.center.x), as_float(s.center.y), as_float(s.center.z), as_float(s.radius)};
    group.surface.push_back(spheres[i].second);
  }
  attach(g, std::move(group));
}

void Tracer::State::attach_quads(const Owned<Rectangle>& quads) {
  if (quads.empty()) return;
  const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  auto* const at = buffer<std::array<float, 3>>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 4 * quads.size());
  auto* const corners = buffer<std::array<unsigned, 4>>(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, quads.size());
  Group group;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const Rectangle& r = quads[i].first;
    const std::array<Vec3, 4> vertices{r.center - r.u - r.v, r.center + r.u - r.v, r.center + r.u + r.v,
                                       r.center - r.u + r.v};
    for (unsigned k = 0; k < 4; ++k) {
      at[4 * i + k] = {as_float(vertices[k].x), as_float(vertices[k].y), as_float(vertices[k].z)};
      corners[i][k] = static_cast<unsigned>(4 * i) + k;
    }
    group.surface.push_back(quads[i].second);
  }
  attach(g, std::move(group));
}

void Tracer::State::attach_discs(const Owned<Disc>& discs) {
  if (discs.empty()) return;
  const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* const at = buffer<std::array<float, 4>>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, discs.size());
  auto* const normals = buffer<std::array<float, 3>>(g, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, discs.size());
  Group group;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const Disc& d = discs[i].first;
    const Vec3 n = normalised(d.normal);
    at[i] = {as_float(d.center.x), as_float(d.center.y), as_float(d.center.z), as_float(d.radius)};
    normals[i] = {as_float(n.x), as_float(n.y), as_float(n.z)};
    group.surface.push_back(discs[i].second);
  }
  attach(g, std::move(group));
}

void Tracer::State::attach_cylinders(std::vector<std::uint32_t> surfaces) {
  if (cylinders.empty()) return;
  const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(cylinders.size()));
  rtcSetGeometryUserData(g, &cylinders);
  rtcSetGeometryBoundsFunction(g, cylinder_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect_cylinder);
  rtcSetGeometryOccludedFunction(g, occlude_cylinder);
  attach(g, {.surface = std::move(surfaces)});
}

void Tracer::State::attach_mesh(const Mesh& mesh, std::uint32_t surface) {
  const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const at = buffer<std::array<float, 3>>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices.size());
  auto* const corners =
      buffer<std::array<unsigned, 3>>(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    at[i] = {as_float(mesh.vertices[i].x), as_float(mesh.vertices[i].y), as_float(mesh.vertices[i].z)};
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) corners[i] = mesh.triangles[i].vertex;
  // Neighbouring triangles share their edges in single precision too: no ray slips between.
  attach(g, {.surface = {surface}, .mesh = true});
}

void Tracer::State::build() {
  Owned<Sphere> spheres;
  Owned<Rectangle> quads;
  Owned<Disc> discs;
  std::vector<std::uint32_t> cylinder_surfaces;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const Shape& shape = objects[i].shape;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) spheres.emplace_back(*sphere, i);
    if (const auto* mesh = std::get_if<Mesh>(&shape)) attach_mesh(*mesh, i);
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      cylinders.push_back(*cylinder);
      cylinder_surfaces.push_back(i);
    }
    const auto* plane = std::get_if<Plane>(&shape);
    if (plane == nullptr) continue;
    const Vec3 normal = normalised(plane->normal);
    if (!plane->half_size) {
      planes.push_back({plane->point, normal, i});
      continue;
    }
    const Frame frame = Frame::about(normal, objects[i].tangent);
    quads.push_back({{plane->point, *plane->half_size * frame.x, *plane->half_size * frame.y}, i});
  }
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    if (!lights[i]) continue;
    const auto surface = static_cast<std::uint32_t>(objects.size()) + i;
    if (const auto* sphere = std::get_if<Sphere>(&lights[i]->shape)) spheres.emplace_back(*sphere, surface);
    if (const auto* quad = std::get_if<Rectangle>(&lights[i]->shape)) quads.emplace_back(*quad, surface);
    if (const auto* disc = std::get_if<Disc>(&lights[i]->shape)) discs.emplace_back(*disc, surface);
  }
  attach_spheres(spheres);
  attach_quads(quads);
  attach_discs(discs);
  attach_cylinders(std::move(cylinder_surfaces));
  rtcCommitScene(scene);
  check("building a scene");
}

double Tracer::State::distance(const Ray& ray, std::uint32_t surface, std::uint32_t triangle) const {
  if (surface >= objects.size()) return distance_to(lights[surface - objects.size()]->shape, ray);
  const Shape& shape = objects[surface].shape;
  if (const auto* s = std::get_if<Sphere>(&shape)) return analytic::sphere(*s, ray.origin, ray.direction);
  if (const auto* p = std::get_if<Plane>(&shape)) {
    return analytic::plane(p->point, p->normal, ray.origin, ray.direction);
  }
  if (const auto* m = std::get_if<Mesh>(&shape)) {
    const auto& t = m->triangles[triangle].vertex;
    const Vec3 a = m->vertices[t[0]];
    return analytic::plane(a, cross(m->vertices[t[1]] - a, m->vertices[t[2]] - a), ray.origin, ray.direction);
  }
  const auto hit = analytic::cylinder(std::get<Cylinder>(shape), ray.origin, ray.direction, 0.0);
  return hit ? hit->distance : std::numeric_limits<double>::infinity();
}

}  // namespace goniofit
