#include "render/clear_views.h"

#include <gtest/gtest.h>

#include <random>

#include "render/render_support.h"
#include "render/tracer.h"

namespace goniofit::test {
namespace {

Scene with(std::vector<Object> objects, std::vector<Light> lights) {
  Scene scene = scene_of(lambertian(0.5));
  scene.objects = std::move(objects);
  scene.lights = std::move(lights);
  return scene;
}

const PointLight lamp_above{.position = {0.0, 0.0, 10.0}, .intensity = {1.0}};

TEST(ClearViews, NothingStandsBetweenALoneBallAndItsLamp) {
  EXPECT_TRUE(ClearViews(with({{Sphere{}, 0}}, {lamp_above})).has(0, 0));
  const Scene sky = with({{Sphere{}, 0}}, {EnvironmentLight{.radiance = {1.0}}});
  EXPECT_FALSE(ClearViews(sky).has(0, 0)) << "a light from everywhere is not proved";
}

TEST(ClearViews, WhatStandsBetweenIsSeen) {
  const Sphere beside{.center = {5.0, 0.0, 0.0}, .radius = 1.0};
  const Sphere between{.center = {0.0, 0.0, 5.0}, .radius = 0.2};
  const ClearViews views(with({{Sphere{}, 0}, {beside, 0}, {between, 0}}, {lamp_above}));
  EXPECT_FALSE(views.has(0, 0));
  EXPECT_TRUE(ClearViews(with({{Sphere{}, 0}, {beside, 0}}, {lamp_above})).has(0, 0));
  const AreaLight panel{.shape = Disc{.center = {0.0, 0.0, 6.0}, .radius = 0.5}, .radiance = {1.0}};
  EXPECT_FALSE(ClearViews(with({{Sphere{}, 0}}, {lamp_above, panel})).has(0, 0)) << "area lights shade too";
  EXPECT_TRUE(ClearViews(with({{Sphere{}, 0}}, {lamp_above, panel})).has(0, 1)) << "but not themselves";
}

TEST(ClearViews, AnEndlessFloorMattersOnTheOtherSideOnly) {
  const Plane floor{.point = {0.0, 0.0, -2.0}};
  const PointLight below{.position = {0.0, 0.0, -5.0}, .intensity = {1.0}};
  const ClearViews views(with({{Sphere{}, 0}, {floor, 0}}, {lamp_above, below}));
  EXPECT_TRUE(views.has(0, 0));
  EXPECT_FALSE(views.has(0, 1));
  EXPECT_FALSE(views.has(1, 0)) << "a floor has no bounds";
}

// Of random scenes: wherever a view is called clear, rays from the surface to the light meet nothing.
TEST(ClearViews, NoRayOfAClearViewIsBlocked) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  std::uniform_real_distribution<double> size(0.2, 1.2);
  std::normal_distribution<double> normal;
  std::size_t clear = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Scene scene = with({}, {});
    for (int i = 0; i < 4; ++i) {
      scene.objects.push_back({Sphere{{place(random), place(random), place(random)}, size(random)}, 0});
    }
    const Vec3 base{place(random), place(random), place(random)};
    scene.objects.push_back({Cylinder{base, base + Vec3{0.0, 1.0, 1.0}, 0.5}, 0});
    const Vec3 at{place(random), place(random), 9.0};
    scene.lights = {PointLight{.position = at, .intensity = {1.0}}};
    const ClearViews views(scene);
    const Tracer tracer(scene);
    for (std::size_t o = 0; o < 4; ++o) {
      if (!views.has(o, 0)) continue;
      ++clear;
      const Sphere& ball = std::get<Sphere>(scene.objects[o].shape);
      for (int k = 0; k < 50; ++k) {
        const Vec3 n = normalised(Vec3{normal(random), normal(random), normal(random)});
        const Vec3 point = ball.center + 1.001 * ball.radius * n;  // clear of single precision
        if (!(dot(at - point, n) > 0.0)) continue;
        const Ray ray{point, normalised(at - point), length(at - point) * (1.0 - 1e-9)};
        std::uint8_t blocked = 0;
        tracer.occluded({&ray, 1}, {&blocked, 1}, false);
        EXPECT_EQ(blocked, 0) << "trial " << trial << ", ball " << o;
      }
    }
  }
  EXPECT_GT(clear, 40U) << "the proof is not too shy";
}

}  // namespace
}  // namespace goniofit::test
