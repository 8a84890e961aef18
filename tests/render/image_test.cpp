// Pictures against closed forms: what single rays see of shapes and lights.

#include <gtest/gtest.h>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "render/obj_reader.h"
#include "render/sphere_scene.h"
#include "render/tracer.h"
#include "render_support.h"
#include "support/error.h"

namespace goniofit::test {
namespace {

constexpr double reflectance = 0.7;

// The ray through the centre of a pixel, as a camera is defined.
Ray through(const Scene& scene, std::size_t row, std::size_t column) {
  const Vec3 back = normalised(scene.camera.position - scene.camera.look_at);
  const Vec3 right = normalised(cross(scene.camera.up, back));
  const Vec3 up = cross(back, right);
  const double half = std::tan(radians(scene.camera.fov_deg) / 2.0);
  const auto height = static_cast<double>(scene.image.height);
  const double x = (2.0 * (static_cast<double>(column) + 0.5) - static_cast<double>(scene.image.width)) / height * half;
  const double y = (height - 2.0 * (static_cast<double>(row) + 0.5)) / height * half;
  return {scene.camera.position, normalised(x * right + y * up - back)};
}

// Radiance of a Lambertian surface under the scene's point lights that see it.
double lambert(const Scene& scene, const Vec3& position, const Vec3& normal) {
  double sum = 0.0;
  for (const Light& light : scene.lights) {
    const auto& lamp = std::get<PointLight>(light);
    const Vec3 to = lamp.position - position;
    const double d = length(to);
    sum += reflectance / pi * lamp.intensity[0] * std::max(0.0, dot(to, normal) / d) / (d * d);
  }
  return sum;
}

Scene one_light(const Shape& shape, const Vec3& lamp) {
  Scene scene = scene_of(lambertian(reflectance));
  scene.objects.push_back({shape, 0});
  scene.lights.emplace_back(PointLight{lamp, {20.0}});
  scene.image = {.width = 97, .height = 64, .samples = 1, .max_bounces = 1};
  scene.camera = {.position = {0.3, -5.0, 1.7}, .look_at = {0.1, 0.0, 0.2}, .fov_deg = 35.0};
  return scene;
}

// Every pixel against the closed form; normal_at gives where and how a ray meets the shape, if it does.
template <class NormalAt>
void expect_image(const Scene& scene, NormalAt&& normal_at, double lit_at_least) {
  const Picture picture = rendered(scene).picture;
  std::size_t lit = 0;
  double worst = 0.0;
  for (std::size_t row = 0; row < picture.height; ++row) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      const Ray ray = through(scene, row, column);
      const auto met = normal_at(ray);
      const double expected = met ? lambert(scene, met->first, met->second) : 0.0;
      const double value = picture.radiance[row * picture.width + column];
      lit += expected > 0.0 ? 1 : 0;
      worst = std::max(worst, std::fabs(value - expected) / std::max(expected, 1e-3));
    }
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(static_cast<double>(lit), lit_at_least * static_cast<double>(picture.width * picture.height));
}

using Met = std::optional<std::pair<Vec3, Vec3>>;

TEST(Image, LambertSphereUnderAPointLight) {
  const Sphere sphere{{0.2, 0.1, 0.3}, 1.1};
  expect_image(
      one_light(sphere, {2.0, -3.0, 2.5}),
      [&](const Ray& ray) -> Met {
        const Vec3 to = sphere.center - ray.origin;
        const double b = dot(to, ray.direction), c = dot(to, to) - sphere.radius * sphere.radius;
        if (b * b < c) return std::nullopt;
        const Vec3 p = ray.origin + (b - std::sqrt(b * b - c)) * ray.direction;
        return Met({p, (1.0 / sphere.radius) * (p - sphere.center)});
      },
      0.2);
}

TEST(Image, EndlessPlaneAndSquareFromBothSides) {
  for (const bool endless : {true, false}) {
    for (const double side : {1.0, -1.0}) {
      Plane plane{{0.0, 0.5, 0.1}, {0.1, -0.2, -side}, std::nullopt};
      if (!endless) plane.half_size = 0.9;
      Scene scene = one_light(plane, {0.5, -1.0, 2.0});
      scene.objects.front().tangent = {1.0, 1.0, 0.0};
      const Vec3 n = normalised(plane.normal);
      const Vec3 x = normalised(scene.objects.front().tangent - dot(scene.objects.front().tangent, n) * n);
      const Vec3 y = cross(n, x);
      expect_image(
          scene,
          [&](const Ray& ray) -> Met {
            const double t = dot(plane.point - ray.origin, n) / dot(ray.direction, n);
            if (!(t > 0.0)) return std::nullopt;
            const Vec3 p = ray.origin + t * ray.direction;
            const Vec3 off = p - plane.point;
            if (!endless && std::max(std::fabs(dot(off, x)), std::fabs(dot(off, y))) > 0.9) return std::nullopt;
            return Met({p, dot(n, ray.direction) < 0.0 ? n : -n});
          },
          0.01);
    }
  }
}

TEST(Image, CylinderWithCaps) {
  const Cylinder cylinder{{-0.6, 0.0, -0.4}, {0.7, 0.2, 0.5}, 0.55, true};
  const Vec3 axis = normalised(cylinder.top - cylinder.base);
  const double height = length(cylinder.top - cylinder.base);
  // By marching along the ray and halving, so that no formula is shared: inside is a distance below 0.
  const auto depth = [&](const Vec3& p) {
    const double along = dot(p - cylinder.base, axis);
    const double across = length(p - cylinder.base - along * axis);
    return std::max({across - cylinder.radius, -along, along - height});
  };
  expect_image(
      one_light(cylinder, {-1.0, -4.0, 2.5}),
      [&](const Ray& ray) -> Met {
        double before = 3.0;
        constexpr double step = 2e-3;
        while (before < 8.0 && depth(ray.origin + (before + step) * ray.direction) > 0.0) before += step;
        if (before >= 8.0) return std::nullopt;
        double after = before + step;
        for (int i = 0; i < 60; ++i) {
          const double middle = 0.5 * (before + after);
          (depth(ray.origin + middle * ray.direction) > 0.0 ? before : after) = middle;
        }
        const Vec3 p = ray.origin + after * ray.direction;
        const double along = dot(p - cylinder.base, axis);
        const Vec3 out = p - cylinder.base - along * axis;
        if (length(out) > cylinder.radius - 1e-9) return Met({p, normalised(out)});
        return Met({p, along > 0.5 * height ? axis : -axis});
      },
      0.05);
}

TEST(Image, TetrahedronFromAFile) {
  std::istringstream obj(
      "# corners of a cube\nv 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1/1 4 2\nf 1 3 4//\n f -3 -1 -2\n");
  obj.str("v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf -3 -1 -2\n");
  Mesh mesh = read_obj(obj, "tetrahedron.obj");
  EXPECT_TRUE(is_closed(mesh));
  place(mesh, {.scale = 0.8, .rotate_deg = {10.0, 20.0, 30.0}, .translate = {0.1, 0.0, 0.2}});
  // As the intersection of four half-spaces.
  std::vector<std::pair<Vec3, double>> faces;
  const Vec3 middle = 0.25 * (mesh.vertices[0] + mesh.vertices[1] + mesh.vertices[2] + mesh.vertices[3]);
  for (const MeshTriangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t.vertex[0]];
    Vec3 n = normalised(cross(mesh.vertices[t.vertex[1]] - a, mesh.vertices[t.vertex[2]] - a));
    if (dot(middle - a, n) > 0.0) n = -n;
    faces.emplace_back(n, dot(a, n));
  }
  expect_image(
      one_light(mesh, {2.0, -4.0, 3.0}),
      [&](const Ray& ray) -> Met {
        double enter = 0.0, leave = 1e9;
        Vec3 normal{};
        for (const auto& [n, d] : faces) {
          const double t = (d - dot(ray.origin, n)) / dot(ray.direction, n);
          if (dot(ray.direction, n) < 0.0 && t > enter) {
            enter = t;
            normal = n;
          }
          if (dot(ray.direction, n) > 0.0) leave = std::min(leave, t);
        }
        if (enter >= leave) return std::nullopt;
        return Met({ray.origin + enter * ray.direction, normal});
      },
      0.1);
}

TEST(Image, ShadingNormalsAreInterpolated) {
  std::istringstream obj("v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nvn -1 -2 0\nvn 1 -2 0\nf 1//1 2//2 3//2 4//1\n");
  const Mesh mesh = read_obj(obj, "panel.obj");
  expect_image(
      one_light(mesh, {0.0, -4.0, 1.0}),
      [&](const Ray& ray) -> Met {
        const Vec3 p = ray.origin - (ray.origin.y / ray.direction.y) * ray.direction;
        if (std::max(std::fabs(p.x), std::fabs(p.z)) > 2.0) return std::nullopt;
        // Unit vectors (∓1, -2, 0)/sqrt(5) mixed by x.
        return Met({p, normalised({p.x / 2.0 / std::sqrt(5.0), -2.0 / std::sqrt(5.0), 0.0})});
      },
      0.5);
}

TEST(Image, ASphereShadesThePlaneBehindIt) {
  Scene scene = one_light(Plane{}, {0.0, 0.0, 4.0});
  scene.objects.push_back({Sphere{{0.0, 0.0, 1.5}, 0.5}, 0});
  scene.camera = {.position = {0.0, -3.0, 1.0}, .look_at = {0.0, 0.0, 0.0}, .fov_deg = 50.0};
  const double shadow = 4.0 * std::tan(std::asin(0.5 / 2.5));
  const Picture picture = rendered(scene).picture;
  std::size_t dark = 0;
  for (std::size_t row = 0; row < picture.height; ++row) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      const Ray ray = through(scene, row, column);
      if (!(ray.direction.z < 0.0)) continue;
      const Vec3 p = ray.origin - (ray.origin.z / ray.direction.z) * ray.direction;
      const Vec3 to = Vec3{0.0, 0.0, 1.5} - ray.origin;
      const bool sphere = length(to - dot(to, ray.direction) * ray.direction) < 0.5;
      if (sphere || std::fabs(std::hypot(p.x, p.y) - shadow) < 1e-4) continue;
      const bool shaded = std::hypot(p.x, p.y) < shadow;
      dark += shaded ? 1 : 0;
      EXPECT_EQ(picture.radiance[row * picture.width + column] == 0.0, shaded) << row << " " << column;
    }
  }
  EXPECT_GT(dark, 100U);
}

// f is f(light, eye): fs as printed is not reciprocal, so that a swap would show.
TEST(Image, TheReflectanceIsReadFromLightToEye) {
  Material m = garnet_red_paint_13();
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  const Evaluator evaluator(m);
  for (const double phi : {180.0, 150.0, 60.0}) {
    Scene scene = floor_scene(m, 80.0, phi);
    const Direction l = direction_of(35.0, 0.0);
    scene.lights.emplace_back(DirectionalLight{{-l.x, -l.y, -l.z}, {2.0, 3.0, 4.0}});
    scene.image.samples = 1;
    const Picture picture = rendered(scene).picture;
    for (std::size_t c = 0; c < 3; ++c) {
      const double f = evaluator.value(make_pair({35.0, 0.0, 80.0, phi}), c);
      EXPECT_NEAR(picture.radiance[c] / ((2.0 + static_cast<double>(c)) * f * l.z), 1.0, 1e-5) << phi;
    }
  }
}

TEST(Image, BrushedSurfacesTurnWithTheirTangent) {
  Material m = single_channel(garnet_red_paint_13());
  m.components = {Effect::dd};
  m.surface = slope_alone(0.1);
  m.surface.slope_y = 0.4;
  const Evaluator evaluator(m);
  for (const double turn : {0.0, 30.0, 90.0}) {
    Scene scene = floor_scene(m, 30.0, 150.0);
    scene.objects.front().brushed_deg = turn;
    const Direction l = direction_of(40.0, 0.0);
    scene.lights.emplace_back(DirectionalLight{{-l.x, -l.y, -l.z}, {1.0}});
    scene.image.samples = 1;
    const double f = evaluator.value(make_pair({40.0, -turn, 30.0, 150.0 - turn}), 0);
    EXPECT_NEAR(rendered(scene).picture.radiance[0] / (f * l.z), 1.0, 1e-6) << turn;
  }
}

TEST(Image, SpheresOfAPaperHaveRadianceOneWhereLightFallsStraight) {
  const Scene scene = sphere_scene(lambertian(1.0), {.size = 101, .light_angle_deg = 0.0, .samples = 1});
  const Picture picture = rendered(scene).picture;
  EXPECT_NEAR(picture.radiance[50 * 101 + 50], 1.0, 1e-4);
  EXPECT_EQ(picture.radiance[50 * 101 + 2], 0.0) << "a margin";
  EXPECT_GT(picture.radiance[50 * 101 + 8], 0.0);
}

}  // namespace
}  // namespace goniofit::test
