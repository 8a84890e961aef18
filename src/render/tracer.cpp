#include "render/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "render/analytic.h"
#include "support/error.h"

namespace goniofit {

namespace {

constexpr std::size_t packet = 16;
constexpr float beyond_all = std::numeric_limits<float>::infinity();

// How many units of single precision a ray starts off its surface, and ends before its target.
constexpr double float_steps = 32.0 * std::numeric_limits<float>::epsilon();

struct PlaneSurface {
  Vec3 point, normal;
  std::uint32_t surface;
};

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

// One geometry of Embree holds all shapes of a kind; this says whose the primitives are.
struct Group {
  std::vector<std::uint32_t> surface;  // by primitive; of a mesh: the one it is
  bool mesh = false;
};

}  // namespace

struct Tracer::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Group> groups;  // by geometry
  std::vector<PlaneSurface> planes;
  std::vector<Cylinder> cylinders;
  std::vector<Object> objects;
  std::vector<std::optional<AreaLight>> lights;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  State(State&&) = delete;
  State& operator=(State&&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void check(const char* doing) const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw system_error(std::string("out of memory ") + doing);
    if (error != RTC_ERROR_NONE) {
      throw system_error(std::string("Embree failed ") + doing + ": error " + std::to_string(static_cast<int>(error)));
    }
  }

  template <class T>
  T* buffer(RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t items, unsigned slot = 0) const {
    void* const data = rtcSetNewGeometryBuffer(g, type, slot, format, sizeof(T), items);
    if (data == nullptr) {
      rtcReleaseGeometry(g);
      check("taking memory for a scene");
      throw system_error("Embree failed taking memory for a scene");
    }
    return static_cast<T*>(data);
  }

  void attach(RTCGeometry g, Group group) {
    rtcCommitGeometry(g);
    const unsigned id = rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    if (groups.size() <= id) groups.resize(id + 1);
    groups[id] = std::move(group);
  }

  void attach_spheres(const std::vector<std::pair<Sphere, std::uint32_t>>& spheres) {
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

  void attach_quads(const std::vector<std::pair<Rectangle, std::uint32_t>>& quads) {
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

  void attach_discs(const std::vector<std::pair<Disc, std::uint32_t>>& discs) {
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

  void attach_cylinders(std::vector<std::uint32_t> surfaces) {
    if (cylinders.empty()) return;
    const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(cylinders.size()));
    rtcSetGeometryUserData(g, &cylinders);
    rtcSetGeometryBoundsFunction(g, cylinder_bounds, nullptr);
    rtcSetGeometryIntersectFunction(g, intersect_cylinder);
    rtcSetGeometryOccludedFunction(g, occlude_cylinder);
    attach(g, {.surface = std::move(surfaces)});
  }

  void attach_mesh(const Mesh& mesh, std::uint32_t surface) {
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

  void build() {
    std::vector<std::pair<Sphere, std::uint32_t>> spheres;
    std::vector<std::pair<Rectangle, std::uint32_t>> quads;
    std::vector<std::pair<Disc, std::uint32_t>> discs;
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

  // Distance along the ray to a surface that Embree says it meets.
  double distance(const Ray& ray, std::uint32_t surface, std::uint32_t triangle) const {
    if (surface >= objects.size()) return light_distance(ray, lights[surface - objects.size()]->shape);
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

  static double light_distance(const Ray& ray, const std::variant<Rectangle, Disc, Sphere>& shape) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return analytic::sphere(*s, ray.origin, ray.direction);
    if (const auto* d = std::get_if<Disc>(&shape)) {
      return analytic::plane(d->center, d->normal, ray.origin, ray.direction);
    }
    const Rectangle& r = std::get<Rectangle>(shape);
    return analytic::plane(r.center, cross(r.u, r.v), ray.origin, ray.direction);
  }
};

namespace {

template <class Packet>
void load(Packet& p, std::size_t i, const Ray& ray) {
  p.org_x[i] = as_float(ray.origin.x);
  p.org_y[i] = as_float(ray.origin.y);
  p.org_z[i] = as_float(ray.origin.z);
  p.dir_x[i] = as_float(ray.direction.x);
  p.dir_y[i] = as_float(ray.direction.y);
  p.dir_z[i] = as_float(ray.direction.z);
  p.tnear[i] = 0.0F;
  p.tfar[i] = as_float(ray.length * (1.0 - float_steps));
  p.time[i] = 0.0F;
  p.mask[i] = ~0U;
  p.id[i] = 0;
  p.flags[i] = 0;
}

RTCIntersectContext context_for(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// Lanes beyond the last ray are off.
void set_valid(int (&valid)[packet], std::size_t count) {
  for (std::size_t i = 0; i < packet; ++i) valid[i] = i < count ? -1 : 0;
}

// Planes without end have no box: they are met before Embree is asked, which then looks no farther.
void meet_planes(const std::vector<PlaneSurface>& planes, const Ray& ray, Hit& hit) {
  for (const PlaneSurface& p : planes) {
    const double t = analytic::plane(p.point, p.normal, ray.origin, ray.direction);
    if (t > 0.0 && t < hit.distance && t < ray.length) hit = {p.surface, 0, t};
  }
}

}  // namespace

Tracer::Tracer(const Scene& scene) {
  auto state = std::make_unique<State>();
  state->device = rtcNewDevice("threads=1");
  if (state->device == nullptr) throw system_error("Embree does not start on this machine");
  state->scene = rtcNewScene(state->device);
  rtcSetSceneFlags(state->scene, RTC_SCENE_FLAG_ROBUST);
  state->objects = scene.objects;
  for (const Light& light : scene.lights) {
    const auto* area = std::get_if<AreaLight>(&light);
    state->lights.push_back(area == nullptr ? std::nullopt : std::optional(*area));
  }
  state->build();
  state_ = std::move(state);
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const {
  RTCIntersectContext context = context_for(coherent);
  RTCRayHit16 packed;
  alignas(64) int valid[packet];
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    const std::size_t count = std::min(packet, rays.size() - first);
    set_valid(valid, count);
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays[first + i];
      Hit& hit = hits[first + i] = {nothing, 0, ray.length};
      meet_planes(state_->planes, ray, hit);
      load(packed.ray, i, ray);
      if (hit.surface != nothing) packed.ray.tfar[i] = as_float(hit.distance);
      packed.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packed.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, state_->scene, &context, &packed);
    for (std::size_t i = 0; i < count; ++i) {
      if (packed.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const Group& group = state_->groups[packed.hit.geomID[i]];
      const std::uint32_t primitive = packed.hit.primID[i];
      const std::uint32_t surface = group.surface[group.mesh ? 0 : primitive];
      hits[first + i] = {surface, primitive, state_->distance(rays[first + i], surface, primitive)};
    }
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, bool coherent) const {
  RTCIntersectContext context = context_for(coherent);
  RTCRay16 packed;
  alignas(64) int valid[packet];
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    const std::size_t count = std::min(packet, rays.size() - first);
    set_valid(valid, count);
    for (std::size_t i = 0; i < count; ++i) {
      Hit hit{nothing, 0, rays[first + i].length};
      meet_planes(state_->planes, rays[first + i], hit);
      blocked[first + i] = hit.surface != nothing ? 1 : 0;
      if (hit.surface != nothing) valid[i] = 0;
      load(packed, i, rays[first + i]);
    }
    rtcOccluded16(valid, state_->scene, &context, &packed);
    for (std::size_t i = 0; i < count; ++i) {
      if (valid[i] != 0 && packed.tfar[i] < 0.0F) blocked[first + i] = 1;
    }
  }
}

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
