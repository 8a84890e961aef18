// Light transport against quadrature: reflection of a sky, of lights with a size, of other surfaces, and in mirrors.

#include <gtest/gtest.h>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "render_support.h"
#include "support/albedo.h"
#include "support/error.h"

namespace goniofit::test {
namespace {

// Four standard errors: 6e-5 of all true statements fail, and the seed is fixed.
void expect_near(const Estimate& e, double expected, double relative, const std::string& what) {
  EXPECT_NEAR(e.mean, expected, 4.0 * e.standard_error + relative * expected) << what;
  EXPECT_LT(e.standard_error, 0.05 * expected) << what << ": the test would not notice";
}

struct FurnaceCase {
  std::string name;
  Material material;
};

std::vector<FurnaceCase> furnace_cases() {
  std::vector<FurnaceCase> cases;
  for (Material m : {garnet_red_paint_13(), laser_paper_73(), ground_glass_41(), smooth_aluminium_45()}) {
    m.forms.fs = FsForm::reciprocal;  // the albedo of the light is that of the eye
    cases.push_back({m.name, single_channel(m)});
    m.terms = he_torrance_terms();
    cases.push_back({m.name + ", He-Torrance", single_channel(m)});
  }
  Material plaster;
  plaster.name = "plaster";
  plaster.components = {Effect::rough};
  plaster.surface.facet_slope_deg = 30.0;
  plaster.channels = {channel("R", 0.65, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0)};
  plaster.channels[0].coefficient(Coefficient::rho) = 0.8;
  cases.push_back({"plaster", plaster});
  Material peer;
  peer.name = "GGX";
  peer.model = "ggx";
  peer.parameters["alpha"] = 0.3;
  MaterialChannel c;
  c.name = "R";
  c.f0 = 0.9;
  c.peer_k = {{"k_d", 0.1}, {"k_s", 0.8}};
  peer.channels = {c};
  cases.push_back({"GGX", peer});
  return cases;
}

TEST(Transport, AFurnaceShowsTheAlbedo) {
  for (const FurnaceCase& one : furnace_cases()) {
    for (const double theta : {10.0, 60.0}) {
      Scene scene = floor_scene(one.material, theta, 0.0, 256);
      scene.lights.emplace_back(EnvironmentLight{{1.0}});
      const Estimate e = estimate(rendered(scene).picture);
      const double albedo = directional_albedo(one.material, theta);
      expect_near(e, albedo, 2e-3, one.name + " at " + std::to_string(theta));
    }
  }
}

// Paths of any length between spheres and a floor: no more comes out than goes in.
TEST(Transport, AFurnaceOfWhiteThingsIsNowhereBrighterThanItsSky) {
  Scene scene = scene_of(lambertian(1.0));
  scene.objects.push_back({Plane{}, 0});
  scene.objects.push_back({Sphere{{0.0, 0.0, 1.0}, 1.0}, 0});
  scene.objects.push_back({Sphere{{1.6, 0.0, 0.6}, 0.6}, 0});
  scene.lights.emplace_back(EnvironmentLight{{1.0}});
  scene.camera = {.position = {0.5, -7.0, 2.0}, .look_at = {0.5, 0.0, 0.8}, .fov_deg = 25.0};
  scene.image = {.width = 24, .height = 24, .samples = 64, .max_bounces = 32};
  const Estimate e = estimate(rendered(scene).picture);
  EXPECT_NEAR(e.mean, 1.0, 4.0 * e.standard_error + 2e-3) << "white things in a white sky are not seen";
  EXPECT_LT(e.standard_error, 5e-3);
}

// Radiance at the origin of the floor towards v, from a rectangle z = height of half sides a and b about `center`.
double from_rectangle(const Material& material, const Direction& v, const Rectangle& r, double radiance) {
  const Evaluator evaluator(material);
  constexpr int steps = 400;
  const Vec3 normal = normalised(cross(r.u, r.v));
  const double area = 4.0 * length(cross(r.u, r.v)) / (steps * steps);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Vec3 p = r.center + ((2 * i + 1.0) / steps - 1.0) * r.u + ((2 * j + 1.0) / steps - 1.0) * r.v;
      const double d = length(p);
      const Direction l{p.x / d, p.y / d, p.z / d};
      sum += evaluator.value(make_pair(l, v), 0) * l.z * -dot(p, normal) / d / (d * d) * area;
    }
  }
  return radiance * sum;
}

TEST(Transport, AnAreaLightOverAGlossyFloorByAllThreeWays) {
  Material m = single_channel(ground_glass_41());
  const Rectangle light{{-1.0, 0.2, 1.2}, {0.5, 0.0, 0.0}, {0.0, -0.4, 0.0}};
  ASSERT_LT(cross(light.u, light.v).z, 0.0) << "shines down";
  Scene scene = floor_scene(m, 40.0, 0.0, 256);
  scene.lights.emplace_back(AreaLight{light, {3.0}});
  const double expected = from_rectangle(m, direction_of(40.0, 0.0), light, 3.0);
  ASSERT_GT(expected, 0.1);
  Estimate both{}, lights{}, model{};
  both = estimate(rendered(scene).picture);
  lights = estimate(rendered(scene, {.sampling = LightSampling::lights}).picture);
  model = estimate(rendered(scene, {.sampling = LightSampling::model}).picture);
  expect_near(both, expected, 1e-4, "both");
  expect_near(lights, expected, 1e-4, "lights");
  expect_near(model, expected, 1e-4, "model");
}

TEST(Transport, DiscsAndSpheresOfOneSolidAngleLightAlike) {
  const Material m = single_channel(ground_glass_41());
  const double distance = 2.0, radius = 0.1;
  const Vec3 place{-distance * 0.6, 0.0, distance * 0.8};
  // From afar a sphere is a disc; the point light of the same intensity is its limit.
  std::vector<Light> lights;
  lights.emplace_back(AreaLight{Sphere{place, radius}, {1.0}});
  lights.emplace_back(AreaLight{Disc{place, -place, radius}, {1.0}});
  lights.emplace_back(PointLight{place, {pi * radius * radius}});
  std::vector<Estimate> estimates;
  for (const Light& light : lights) {
    for (const LightSampling way : {LightSampling::both, LightSampling::lights, LightSampling::model}) {
      if (way == LightSampling::model && std::holds_alternative<PointLight>(light)) continue;
      Scene scene = floor_scene(m, 20.0, 0.0, 512);
      scene.lights.push_back(light);
      estimates.push_back(estimate(rendered(scene, {.sampling = way}).picture));
    }
  }
  ASSERT_GT(estimates.back().mean, 1e-3);
  for (const Estimate& e : estimates) {
    EXPECT_NEAR(e.mean, estimates.back().mean, 4.0 * e.standard_error + 5e-3 * estimates.back().mean);
    EXPECT_LT(e.standard_error, 0.1 * e.mean);
  }
}

TEST(Transport, AMapOfOneColourIsTheSkyOfThatColour) {
  const Material m = single_channel(ground_glass_41());
  auto map = std::make_shared<EnvironmentMap>();
  map->width = 16;
  map->height = 8;
  map->values.assign(128, 0.5);
  Scene scene = floor_scene(m, 50.0, 20.0, 256);
  scene.lights.emplace_back(EnvironmentLight{{2.0}, map, 33.0});
  const double albedo = directional_albedo(m, 50.0);
  for (const LightSampling way : {LightSampling::both, LightSampling::lights, LightSampling::model}) {
    expect_near(estimate(rendered(scene, {.sampling = way}).picture), albedo, 2e-3, "map");
  }
}

// One bright cell: where it stands, how rotation turns it, and that both ways of finding it agree.
TEST(Transport, AMapsCellsStandWhereTheirAnglesSay) {
  const Material m = lambertian(0.5);
  auto map = std::make_shared<EnvironmentMap>();
  map->width = 8;
  map->height = 6;
  map->values.assign(48, 0.0);
  map->values[1 * 8 + 2] = 4.0;  // theta 30 to 60, azimuth 90 to 135 degrees
  // Irradiance of the cell: integral of cos sin, times its width in azimuth.
  const double irradiance = 4.0 * pi / 4.0 * 0.5 * (std::pow(std::sin(radians(60.0)), 2) - 0.25);
  Scene scene = floor_scene(m, 30.0, 0.0, 256);
  scene.lights.emplace_back(EnvironmentLight{{1.0}, map, 0.0});
  for (const LightSampling way : {LightSampling::both, LightSampling::lights, LightSampling::model}) {
    expect_near(estimate(rendered(scene, {.sampling = way}).picture), 0.5 / pi * irradiance, 1e-6, "cell");
  }
  // A camera that looks at its middle, and one at where it was before a turn by 90 degrees.
  for (const auto& [rotation, seen] : {std::pair{0.0, 4.0}, std::pair{90.0, 0.0}}) {
    std::get<EnvironmentLight>(scene.lights.front()).rotation_deg = rotation;
    const Direction to = direction_of(45.0, 112.5);
    scene.camera.position = {0.0, 0.0, 1.0};
    scene.camera.look_at = {to.x, to.y, 1.0 + to.z};
    EXPECT_EQ(rendered(scene).picture.radiance[0], seen) << rotation;
  }
}

// A floor in the shadow of nothing but without light of its own: a lit wall beside it is all that it sees.
TEST(Transport, AWallLightsTheFloor) {
  Scene scene = floor_scene(lambertian(0.6), 40.0, 0.0, 1024);
  const double half = 0.8, away = 1.0;
  scene.objects.push_back({Plane{{-away, 0.0, half}, {1.0, 0.0, 0.0}, half}, 0});
  scene.lights.emplace_back(DirectionalLight{{-1.0, 0.0, 0.0}, {5.0}});
  scene.image.max_bounces = 2;
  const double wall = 0.6 / pi * 5.0;
  constexpr int steps = 500;
  double irradiance = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Vec3 p{-away, half * ((2 * i + 1.0) / steps - 1.0), half * (2 * j + 1.0) / steps};
      const double d2 = dot(p, p);
      irradiance += wall * p.z * away / (d2 * d2) * (4.0 * half * half / (steps * steps));
    }
  }
  expect_near(estimate(rendered(scene).picture), 0.6 / pi * irradiance, 1e-4, "wall");
  scene.image.indirect = 0.25;
  const Estimate thinned = estimate(rendered(scene).picture);
  expect_near(thinned, 0.6 / pi * irradiance, 1e-4, "wall, a quarter of the paths");
  const std::uint64_t quarter = rendered(scene).work.path_rays;
  EXPECT_NEAR(static_cast<double>(quarter), 0.25 * 64 * 1024, 0.01 * 64 * 1024);
  scene.image.path_limit = 1e-3 * thinned.mean;
  EXPECT_LT(estimate(rendered(scene).picture).mean, 1e-3 * thinned.mean) << "each path is cut";
  EXPECT_GT(estimate(rendered(scene).picture).mean, 0.0);
  scene.image.max_bounces = 1;
  EXPECT_EQ(estimate(rendered(scene).picture).mean, 0.0) << "direct light alone";
}

// Two spheres lit from one side; what the first sends to a point of the second, by a sum over its surface.
TEST(Transport, OneSphereLightsAnother) {
  const double reflectance = 0.8;
  Scene scene = scene_of(lambertian(reflectance));
  const Sphere lit{{-1.5, 0.0, 0.0}, 1.0}, other{{1.5, 0.0, 0.0}, 1.0};
  scene.objects = {{lit, 0}, {other, 0}};
  scene.lights.emplace_back(DirectionalLight{{-1.0, 0.0, -1.0}, {3.0}});
  const Vec3 sun = normalised({1.0, 0.0, 1.0});
  // A point of the other sphere that faces the lit one and not the sun.
  const Vec3 n = normalised({-1.0, -0.3, -0.2});
  const Vec3 p = other.center + n;
  ASSERT_LT(dot(n, sun), 0.0);
  scene.camera.position = p + 0.4 * normalised({-1.0, -1.2, -0.6});
  scene.camera.look_at = p;
  scene.camera.fov_deg = 1e-6;
  scene.image = {.width = 8, .height = 8, .samples = 1024, .max_bounces = 2};
  double irradiance = 0.0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double z = (2 * i + 1.0) / steps - 1.0, phi = 2.0 * pi * (j + 0.5) / steps;
      const Vec3 m{std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z};
      const Vec3 q = lit.center + m;
      const Vec3 to = p - q;
      const double d2 = dot(to, to);
      // What of the lit sphere lies in the shadow of the other: rays towards the sun that meet it.
      const Vec3 off = other.center - q;
      const double along = dot(off, sun);
      const bool shaded = along > 0.0 && dot(off, off) - along * along < 1.0;
      if (shaded || dot(m, sun) <= 0.0 || dot(m, to) <= 0.0 || dot(n, to) >= 0.0) continue;
      const double radiance = reflectance / pi * 3.0 * dot(m, sun);
      irradiance += radiance * dot(m, to) * -dot(n, to) / (d2 * d2) * (4.0 * pi / (steps * steps));
    }
  }
  ASSERT_GT(irradiance, 0.01);
  expect_near(estimate(rendered(scene).picture), reflectance / pi * irradiance, 2e-3, "spheres");
}

// ---- mirrors

// Under the name and at the wavelength of the other's only channel.
Material as_channel_of(Material m, const Material& other) {
  m = single_channel(m);
  m.channels[0].name = other.channels[0].name;
  m.channels[0].wavelength_um = other.channels[0].wavelength_um;
  return m;
}

double mirror_weight(const Material& m, double theta) {
  const Evaluator evaluator(m);
  const Pair pair = make_pair({theta, 0.0, theta, 180.0});
  return evaluator.value(pair, 0, Effect::coh) * pair.cos_i * m.solid_angle_sr;
}

TEST(Mirror, ShowsDiscsOfLightsWithTheirRadiance) {
  Material m = single_channel(smooth_aluminium_45());
  m.components = {Effect::coh};
  const double theta = 75.0, weight = mirror_weight(m, theta);
  ASSERT_GT(weight, 1e-3);
  const Direction l = direction_of(theta, 180.0);
  const Vec3 to{l.x, l.y, l.z};
  const double radius = 0.05, diameter_deg = 2.0;
  const double sine = std::sin(radians(0.5 * diameter_deg));
  const std::vector<std::pair<Light, double>> lights{
      {PointLight{2.0 * to, {7.0}, radius}, 7.0 / (pi * radius * radius)},
      {PointLight{2.0 * to, {7.0}}, 0.0},
      {DirectionalLight{-to, {7.0}, diameter_deg}, 7.0 / (pi * sine * sine)},
      {DirectionalLight{-to, {7.0}}, 0.0},
      {AreaLight{Disc{2.0 * to, -to, radius}, {7.0}}, 7.0},
      {AreaLight{Sphere{2.0 * to, radius}, {7.0}}, 7.0},
      {EnvironmentLight{{7.0}}, 7.0}};
  for (const auto& [light, radiance] : lights) {
    Scene scene = floor_scene(m, theta);
    scene.lights.push_back(light);
    const Rendering rendering = rendered(scene);
    EXPECT_NEAR(rendering.picture.radiance[0], weight * radiance, 1e-6 * weight * radiance) << light.index();
    EXPECT_EQ(mirror_shows(light), radiance > 0.0);
    EXPECT_EQ(rendering.notes.empty(), radiance > 0.0) << "what the mirror does not show is said";
    // Half a degree beside the image nothing is there but the sky.
    scene.camera.position = {3.0 * std::sin(radians(theta + 3.0)), 0.0, 3.0 * std::cos(radians(theta + 3.0))};
    const bool sky = std::holds_alternative<EnvironmentLight>(light);
    EXPECT_EQ(rendered(scene).picture.radiance[0] > 0.0, sky) << light.index();
  }
}

TEST(Mirror, ShowsSurfacesAndWhatStandsBetween) {
  Material m = single_channel(smooth_aluminium_45());
  Scene scene = floor_scene(m, 50.0);
  m.components = {Effect::coh};
  scene.materials = {{"mirror", {}, m}, {"white", {}, as_channel_of(lambertian(0.5), m)}};
  scene.objects.push_back({Plane{{-2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 1});
  const Direction l = direction_of(50.0, 180.0);
  scene.lights.emplace_back(DirectionalLight{{-1.0, 0.0, 0.0}, {3.0}});
  scene.image.max_bounces = 2;
  const double expected = mirror_weight(m, 50.0) * 0.5 / pi * 3.0;
  EXPECT_NEAR(rendered(scene).picture.radiance[0], expected, 1e-6 * expected);
  scene.lights.emplace_back(PointLight{10.0 * Vec3{l.x, l.y, l.z}, {7.0}, 1.0});
  EXPECT_NEAR(rendered(scene).picture.radiance[0], expected, 1e-6 * expected) << "the wall hides the lamp";
}

// ---- what the picture must not depend on

Scene mixed_scene() {
  Scene scene = scene_of(smooth_aluminium_45());
  scene.materials.push_back({"paint", {}, as_channel_of(garnet_red_paint_13(), scene.materials[0].material)});
  scene.objects = {
      {Plane{}, 1}, {Sphere{{0.0, 0.0, 1.0}, 1.0}, 0}, {Cylinder{{2.0, 0.0, 0.0}, {2.0, 0.0, 1.5}, 0.5}, 1}};
  scene.lights.emplace_back(PointLight{{2.0, -3.0, 4.0}, {30.0}, 0.1});
  scene.lights.emplace_back(AreaLight{Sphere{{-3.0, -1.0, 3.0}, 0.4}, {4.0}});
  scene.lights.emplace_back(EnvironmentLight{{0.2}});
  scene.camera = {.position = {0.5, -6.0, 2.0}, .look_at = {0.5, 0.0, 0.8}, .fov_deg = 35.0};
  scene.image = {.width = 70, .height = 50, .samples = 5, .max_bounces = 4};
  return scene;
}

TEST(Determinism, OneThreadOrMoreAndTheSameSeed) {
  Scene scene = mixed_scene();
  const Picture one = rendered(scene, {.threads = 1}).picture;
  EXPECT_EQ(one.radiance, rendered(scene, {.threads = 2}).picture.radiance);
  EXPECT_EQ(one.radiance, rendered(scene, {.threads = 5}).picture.radiance);
  scene.image.seed = 2;
  EXPECT_NE(one.radiance, rendered(scene).picture.radiance);
}

// Materials that differ by a little make pictures that do, though the samples are few: the random numbers are the same.
TEST(Determinism, AnotherMaterialMeetsTheSameRandomNumbers) {
  const Scene scene = mixed_scene();
  const Picture given = rendered(scene).picture;
  std::vector<RenderMaterial> others = given_materials(scene);
  for (RenderMaterial& m : others) m.compile.tolerance = 1e-4;
  const Picture planned = render(scene, others).picture;
  EXPECT_NE(given.radiance, planned.radiance);
  double difference = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < given.radiance.size(); ++i) {
    difference += std::fabs(given.radiance[i] - planned.radiance[i]);
    sum += given.radiance[i];
  }
  EXPECT_LT(difference, 1e-4 * sum);
  for (RenderMaterial& m : others) m.single_precision = true;
  const Picture single = render(scene, others).picture;
  difference = 0.0;
  for (std::size_t i = 0; i < given.radiance.size(); ++i) {
    difference += std::fabs(given.radiance[i] - single.radiance[i]);
  }
  EXPECT_LT(difference, 2e-4 * sum);
}

// A plan that leaves coh out changes what coh brought, and nothing else: everywhere darker, and where no mirror is met,
// even by way of other surfaces, the same to the last digit.
TEST(Determinism, WithoutAMirrorTheOtherPathsStay) {
  Scene scene = mixed_scene();
  scene.image.max_bounces = 6;
  const Picture given = rendered(scene).picture;
  std::vector<RenderMaterial> others = given_materials(scene);
  others[0].material.components.erase(Effect::coh);
  const Picture without = render(scene, others).picture;
  std::size_t same = 0, darker = 0;
  for (std::size_t i = 0; i < given.radiance.size(); ++i) {
    EXPECT_LE(without.radiance[i], given.radiance[i] * (1.0 + 1e-12));
    same += without.radiance[i] == given.radiance[i] ? 1 : 0;
    darker += without.radiance[i] < given.radiance[i] ? 1 : 0;
  }
  EXPECT_GT(same, given.radiance.size() / 4);
  EXPECT_GT(darker, given.radiance.size() / 20);
}

TEST(Determinism, MaterialsMustBeAsManyAndOfTheSameChannels) {
  const Scene scene = mixed_scene();
  std::vector<RenderMaterial> others = given_materials(scene);
  others[1].material.channels.push_back(others[1].material.channels.front());
  EXPECT_THROW((void)render(scene, others), Error);
  others.pop_back();
  EXPECT_THROW((void)render(scene, others), Error);
}

}  // namespace
}  // namespace goniofit::test
