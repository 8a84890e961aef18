#include "render/clear_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

namespace goniofit {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

struct Ball {
  Vec3 center;
  double radius;
};

struct BallOf {
  std::optional<Ball> operator()(const Sphere& s) const { return Ball{s.center, s.radius}; }
  std::optional<Ball> operator()(const Plane& p) const {
    if (!p.half_size) return std::nullopt;
    return Ball{p.point, std::sqrt(2.0) * *p.half_size};
  }
  std::optional<Ball> operator()(const Cylinder& c) const {
    return Ball{0.5 * (c.base + c.top), std::hypot(0.5 * length(c.top - c.base), c.radius)};
  }
  std::optional<Ball> operator()(const Mesh& m) const {
    Vec3 least{endless, endless, endless};
    Vec3 most{-endless, -endless, -endless};
    for (const Vec3& v : m.vertices) {
      least = {std::min(least.x, v.x), std::min(least.y, v.y), std::min(least.z, v.z)};
      most = {std::max(most.x, v.x), std::max(most.y, v.y), std::max(most.z, v.z)};
    }
    return Ball{0.5 * (least + most), 0.5 * length(most - least)};
  }
  std::optional<Ball> operator()(const Rectangle& r) const {
    return Ball{r.center, std::sqrt(dot(r.u, r.u) + dot(r.v, r.v) + 2.0 * std::fabs(dot(r.u, r.v)))};
  }
  std::optional<Ball> operator()(const Disc& d) const { return Ball{d.center, d.radius}; }
};

// Seen from a point of its own outside, none of it is in the way.
bool shades_itself(const Shape& shape) {
  if (std::holds_alternative<Mesh>(shape)) return true;
  const Cylinder* cylinder = std::get_if<Cylinder>(&shape);
  return cylinder != nullptr && !cylinder->caps;
}

double distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double square = dot(along, along);
  const double t = square > 0.0 ? std::clamp(dot(point - from, along) / square, 0.0, 1.0) : 0.0;
  return length(point - (from + t * along));
}

// All that lies between a ball and a light: within `radius` of a segment.
struct Passage {
  Vec3 from, to;
  double radius;

  [[nodiscard]] bool misses(const Ball& b) const {
    return distance_to_segment(b.center, from, to) > (b.radius + radius) * (1.0 + slack);
  }
  [[nodiscard]] bool misses(const Plane& endless_plane) const {
    const Vec3 normal = normalised(endless_plane.normal);
    const double a = dot(from - endless_plane.point, normal);
    const double b = dot(to - endless_plane.point, normal);
    return std::min(std::fabs(a), std::fabs(b)) > radius * (1.0 + slack) && (a > 0.0) == (b > 0.0);
  }

 private:
  static constexpr double slack = 1e-6;
};

// Null where the light is everywhere.
std::optional<Passage> passage_to(const Light& light, const Ball& ball, double reach) {
  if (const auto* point = std::get_if<PointLight>(&light)) return Passage{ball.center, point->position, ball.radius};
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
    return Passage{ball.center, ball.center - reach * normalised(sun->direction), ball.radius};
  }
  if (const auto* area = std::get_if<AreaLight>(&light)) {
    const Ball of_light = *std::visit(BallOf{}, area->shape);
    return Passage{ball.center, of_light.center, std::max(ball.radius, of_light.radius)};
  }
  return std::nullopt;
}

bool in_the_way(const Shape& shape, const Passage& passage) {
  const Plane* plane = std::get_if<Plane>(&shape);
  if (plane != nullptr && !plane->half_size) return !passage.misses(*plane);
  return !passage.misses(*std::visit(BallOf{}, shape));
}

bool is_clear(const Scene& scene, std::size_t object, std::size_t light, double reach) {
  const Shape& shape = scene.objects[object].shape;
  const std::optional<Ball> ball = std::visit(BallOf{}, shape);
  if (!ball || shades_itself(shape)) return false;
  const std::optional<Passage> passage = passage_to(scene.lights[light], *ball, reach);
  if (!passage) return false;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (o != object && in_the_way(scene.objects[o].shape, *passage)) return false;
  }
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const auto* area = std::get_if<AreaLight>(&scene.lights[l]);
    if (l != light && area != nullptr && !passage->misses(*std::visit(BallOf{}, area->shape))) return false;
  }
  return true;
}

// Beyond this from the origin there is nothing but endless planes.
double extent(const Scene& scene) {
  double most = 0.0;
  const auto add = [&most](const std::optional<Ball>& ball) {
    if (ball) most = std::max(most, length(ball->center) + ball->radius);
  };
  for (const Object& o : scene.objects) add(std::visit(BallOf{}, o.shape));
  for (const Light& light : scene.lights) {
    if (const auto* area = std::get_if<AreaLight>(&light)) add(std::visit(BallOf{}, area->shape));
  }
  return most;
}

bool has_endless_plane(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& o) {
    const Plane* plane = std::get_if<Plane>(&o.shape);
    return plane != nullptr && !plane->half_size;
  });
}

}  // namespace

ClearViews::ClearViews(const Scene& scene) : lights_(scene.lights.size()) {
  const double reach = 4.0 * extent(scene);
  const bool planes = has_endless_plane(scene);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    for (std::size_t l = 0; l < lights_; ++l) {
      // A beam that comes from afar may cross an endless plane anywhere.
      const bool afar = planes && std::holds_alternative<DirectionalLight>(scene.lights[l]);
      clear_.push_back(!afar && is_clear(scene, o, l, reach) ? 1 : 0);
    }
  }
}

}  // namespace goniofit
