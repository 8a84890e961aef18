#include "render/tracer.h"

#include <algorithm>

#include "render/analytic.h"
#include "render/tracer_state.h"

namespace goniofit {

namespace {

constexpr std::size_t packet = 16;

float as_float(double x) { return static_cast<float>(x); }

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
template <class Planes>
void meet_planes(const Planes& planes, const Ray& ray, Hit& hit) {
  for (const auto& p : planes) {
    const double t = analytic::plane(p.point, p.normal, ray.origin, ray.direction);
    if (t > 0.0 && t < hit.distance && t < ray.length) hit = {p.surface, 0, t};
  }
}

}  // namespace

Tracer::Tracer(const Scene& scene) : state_(std::make_unique<const State>(scene)) {}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const {
  RTCIntersectContext context = context_for(coherent);
  RTCRayHit16 packed{};  // lanes that no ray fills shall hold numbers all the same
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
      const State::Group& group = state_->groups[packed.hit.geomID[i]];
      const std::uint32_t primitive = packed.hit.primID[i];
      const std::uint32_t surface = group.surface[group.mesh ? 0 : primitive];
      hits[first + i] = {surface, primitive, state_->distance(rays[first + i], surface, primitive)};
    }
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, bool coherent) const {
  RTCIntersectContext context = context_for(coherent);
  RTCRay16 packed{};
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

}  // namespace goniofit
