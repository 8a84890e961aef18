// What makes a scene one that can be rendered.

#include <algorithm>
#include <string>

#include "render/obj_reader.h"
#include "render/scene.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Distances of a ray from p along d through the triangle, > 0 (Möller & Trumbore 1997).
bool crosses(const Vec3& p, const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, q = cross(d, ac);
  const double determinant = dot(ab, q);
  if (determinant == 0.0) return false;
  const double u = dot(p - a, q) / determinant;
  const Vec3 r = cross(p - a, ab);
  const double v = dot(d, r) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && dot(ac, r) / determinant > 0.0;
}

bool inside(const Sphere& s, const Vec3& p) { return length(p - s.center) < s.radius; }
bool inside(const Plane&, const Vec3&) { return false; }
bool inside(const Cylinder& c, const Vec3& p) {
  const Vec3 axis = c.top - c.base;
  const double along = dot(p - c.base, axis) / dot(axis, axis);
  return c.caps && along > 0.0 && along < 1.0 && length(p - c.base - along * axis) < c.radius;
}
// By the parity of crossings, in a direction that no one's edges have.
bool inside(const Mesh& m, const Vec3& p) {
  const Vec3 direction = normalised({0.2718281828, 0.5772156649, 0.7706132071});
  std::size_t crossings = 0;
  for (const MeshTriangle& t : m.triangles) {
    crossings +=
        crosses(p, direction, m.vertices[t.vertex[0]], m.vertices[t.vertex[1]], m.vertices[t.vertex[2]]) ? 1 : 0;
  }
  return crossings % 2 == 1 && is_closed(m);
}

class Check {
 public:
  Check(const Scene& scene, const std::string& where) : scene_(scene), where_(where) {}

  void run() {
    image();
    materials();
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) object(scene_.objects[i], i);
    if (scene_.objects.empty()) fail("/objects", "is empty, expected at least one object");
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) light(scene_.lights[i], i);
    const bool dark =
        std::all_of(scene_.lights.begin(), scene_.lights.end(), [](const Light& l) { return is_dark(l); });
    if (scene_.lights.empty()) fail("/lights", "is empty, expected at least one light");
    if (dark) fail("/lights", "none of them shines, expected one whose spectrum is above 0");
    camera();
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    throw key_error(where_, pointer, what);
  }
  void require(bool holds, const std::string& pointer, const std::string& what) const {
    if (!holds) fail(pointer, what);
  }
  void finite(const Vec3& v, const std::string& pointer) const {
    require(is_finite(v) && largest_component(v) <= 1e15, pointer,
            "is not finite or beyond 1e15, expected a number within it");
  }
  void direction(const Vec3& v, const std::string& pointer) const {
    finite(v, pointer);
    require(length(v) > 1e-15, pointer, "is the zero vector, expected a direction");
  }
  void size(double value, const std::string& pointer) const {
    require(value > 0.0 && value <= 1e15, pointer,
            "is " + shortest(value) + ", expected a number above 0 and up to 1e15");
  }

  void image() const {
    const ImageSettings& image = scene_.image;
    require(image.width > 0 && image.height > 0 && image.width <= most_pixels / image.height, "/image",
            "is of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels, expected 1 to " +
                std::to_string(most_pixels));
    require(image.samples > 0 && image.samples <= most_samples, "/image/samples",
            "is " + std::to_string(image.samples) + ", expected 1 to " + std::to_string(most_samples));
    require(image.max_bounces > 0 && image.max_bounces <= most_bounces, "/image/max_bounces",
            "is " + std::to_string(image.max_bounces) + ", expected 1 to " + std::to_string(most_bounces));
    require(!image.path_limit || *image.path_limit > 0.0, "/image/path_limit", "expected a number above 0");
    require(image.indirect > 0.0 && image.indirect <= 1.0, "/image/indirect",
            "is " + shortest(image.indirect) + ", expected a number above 0 and up to 1");
  }

  void materials() const {
    require(!scene_.materials.empty(), "/materials", "is empty, expected at least one material");
    for (const SceneMaterial& m : scene_.materials) {
      const std::string pointer = "/materials" + pointer_step(m.name);
      goniofit::validate(m.material, m.file.empty() ? where_ : m.file.string());
      std::vector<SceneChannel> channels;
      for (const MaterialChannel& c : m.material.channels) channels.push_back({c.name, c.wavelength_um});
      require(same(channels), pointer,
              "has the channels " + listed(channels) + ", expected those of the other materials, " +
                  listed(scene_.channels));
    }
  }
  // A wavelength that only one of two materials knows does not set them apart.
  bool same(const std::vector<SceneChannel>& channels) const {
    return std::equal(channels.begin(), channels.end(), scene_.channels.begin(), scene_.channels.end(),
                      [](const SceneChannel& a, const SceneChannel& b) {
                        const double apart =
                            a.wavelength_um && b.wavelength_um ? *a.wavelength_um - *b.wavelength_um : 0.0;
                        return a.name == b.name && std::fabs(apart) < 1e-6;
                      });
  }
  static std::string listed(const std::vector<SceneChannel>& channels) {
    std::string text;
    for (const SceneChannel& c : channels) {
      text += (text.empty() ? "" : " ") + in_quotes(c.name);
      if (c.wavelength_um) text += " (" + shortest(*c.wavelength_um) + " um)";
    }
    return text;
  }

  void shape(const Sphere& s, const std::string& at) const {
    finite(s.center, at + "/center");
    size(s.radius, at + "/radius");
  }
  void shape(const Plane& p, const std::string& at) const {
    finite(p.point, at + "/point");
    direction(p.normal, at + "/normal");
    if (p.half_size) size(*p.half_size, at + "/half_size");
  }
  void shape(const Cylinder& c, const std::string& at) const {
    finite(c.base, at + "/base");
    finite(c.top, at + "/top");
    size(c.radius, at + "/radius");
    require(length(c.top - c.base) > 0.0, at + "/top", "is the base itself, expected the centre of the other end");
  }
  void shape(const Mesh& m, const std::string& at) const {
    require(!m.triangles.empty(), at, "has no triangles, expected at least one");
    for (const Vec3& v : m.vertices) finite(v, at);
  }
  void object(const Object& o, std::size_t i) const {
    const std::string at = "/objects/" + std::to_string(i);
    std::visit([&](const auto& s) { shape(s, at); }, o.shape);
    direction(o.tangent, at + "/tangent");
    require(o.material < scene_.materials.size(), at + "/material", "is no material, expected one of the scene's");
  }

  void emission(const Spectrum& spectrum, const std::string& pointer) const {
    const bool good = spectrum.size() == scene_.channels.size() &&
                      std::all_of(spectrum.begin(), spectrum.end(), [](double v) { return v >= 0.0 && v <= 1e30; });
    require(
        good, pointer,
        "expected one number of at least 0 for each of the " + std::to_string(scene_.channels.size()) + " channels");
  }
  void emitter(const Rectangle& r, const std::string& at) const {
    finite(r.center, at + "/center");
    direction(r.u, at + "/u");
    direction(r.v, at + "/v");
    const double area = length(cross(r.u, r.v));
    require(area > 1e-10 * length(r.u) * length(r.v), at + "/v",
            "is parallel to u: the light has no area, expected the other side");
  }
  void emitter(const Disc& d, const std::string& at) const {
    finite(d.center, at + "/center");
    direction(d.normal, at + "/normal");
    size(d.radius, at + "/radius");
  }
  void emitter(const Sphere& s, const std::string& at) const {
    shape(s, at);
    require(!inside(s, scene_.camera.position), "/camera/position",
            "is inside " + at.substr(1) + ", expected a place outside");
  }
  void light(const Light& light, std::size_t i) const {
    const std::string at = "/lights/" + std::to_string(i);
    if (const auto* point = std::get_if<PointLight>(&light)) {
      finite(point->position, at + "/position");
      require(point->radius >= 0.0 && point->radius <= 1e15, at + "/radius", "expected a number of at least 0");
      emission(point->intensity, at + "/intensity");
    } else if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
      direction(sun->direction, at + "/direction");
      require(sun->diameter_deg >= 0.0 && sun->diameter_deg < 180.0, at + "/diameter_deg",
              "expected degrees from 0 to below 180");
      emission(sun->irradiance, at + "/irradiance");
    } else if (const auto* area = std::get_if<AreaLight>(&light)) {
      std::visit([&](const auto& s) { emitter(s, at); }, area->shape);
      emission(area->radiance, at + "/radiance");
    } else {
      emission(std::get<EnvironmentLight>(light).radiance, at + "/radiance");
    }
  }

  void camera() const {
    const Camera& c = scene_.camera;
    finite(c.position, "/camera/position");
    finite(c.look_at, "/camera/look_at");
    direction(c.up, "/camera/up");
    require(c.fov_deg > 0.0 && c.fov_deg < 180.0, "/camera/fov_deg",
            "is " + shortest(c.fov_deg) + ", expected degrees above 0 and below 180");
    const Vec3 ahead = c.look_at - c.position;
    require(length(ahead) > 0.0, "/camera/look_at", "is the camera's own position, expected a point ahead of it");
    const double across = length(cross(normalised(ahead), normalised(c.up)));
    require(across > 1e-9, "/camera/up", "is parallel to the line of sight, expected another direction");
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      const bool within = std::visit([&](const auto& s) { return inside(s, c.position); }, scene_.objects[i].shape);
      require(!within, "/camera/position", "is inside objects/" + std::to_string(i) + ", expected a place outside");
    }
  }

  const Scene& scene_;
  const std::string& where_;
};

}  // namespace

void validate(const Scene& scene, const std::string& where) { Check(scene, where).run(); }

}  // namespace goniofit
