#include "render/scene_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/evaluator.h"
#include "render/picture_difference.h"
#include "render/render_support.h"
#include "render/scene_plan_report.h"
#include "support/error_message.h"

namespace goniofit::test {
namespace {

ScenePlanSettings quick() {
  ScenePlanSettings s;
  s.survey.pixels = 1024;
  s.survey.samples = 2;
  return s;
}

// A square metre of metal, looked at from straight above.
Scene plate(const Material& material) {
  Scene scene = scene_of(material);
  scene.objects.push_back({Plane{.point = {}, .normal = {0.0, 0.0, 1.0}, .half_size = 0.5}, 0});
  scene.camera = {.position = {0.0, 0.0, 4.0}, .look_at = {}, .up = {0.0, 1.0, 0.0}, .fov_deg = 12.0};
  scene.image.width = scene.image.height = 64;
  scene.image.samples = 4;
  return scene;
}

// Half a percent of what it reflects near the normal is coherent.
Material dull_mirror() {
  Material m = with_surface(smooth_aluminium_45(), 0.1, 5.0);
  m.components = {Effect::coh, Effect::dd};
  return m;
}

// Under the names and wavelengths of another's channels, all like its first.
Material in_channels_of(const Material& other, Material m) {
  const MaterialChannel first = m.channels.front();
  m.channels.clear();
  for (const MaterialChannel& c : other.channels) {
    m.channels.push_back(first);
    m.channels.back().name = c.name;
    m.channels.back().wavelength_um = c.wavelength_um;
  }
  return m;
}

// Spheres of the paper's samples and of plaster above a floor of it, under two lamps.
Scene five_materials() {
  Scene scene = scene_of(garnet_red_paint_13());
  scene.materials.push_back({"paper", {}, laser_paper_73()});
  scene.materials.push_back({"glass", {}, ground_glass_41()});
  scene.materials.push_back({"aluminium", {}, in_channels_of(garnet_red_paint_13(), smooth_aluminium_45())});
  scene.materials.push_back({"plaster", {}, in_channels_of(garnet_red_paint_13(), rough_plaster())});
  scene.objects.push_back({Plane{}, 4});
  for (std::size_t m = 0; m < 4; ++m) {
    const auto x = static_cast<double>(m);
    scene.objects.push_back({Sphere{.center = {2.4 * x - 3.6, 0.3 * x, 1.0}, .radius = 1.0}, m});
  }
  scene.lights.push_back(PointLight{.position = {-4.0, -6.0, 6.0}, .intensity = flat(scene, 100.0), .radius = 0.2});
  scene.lights.push_back(PointLight{.position = {6.0, 3.0, 5.0}, .intensity = flat(scene, 60.0)});
  scene.camera = {.position = {0.0, -12.0, 4.0}, .look_at = {0.0, 0.0, 0.8}, .fov_deg = 30.0};
  scene.image.width = 96;
  scene.image.height = 64;
  scene.image.samples = 8;
  scene.image.max_bounces = 2;
  return scene;
}

const Plan& plan_of(const ScenePlan& p, std::size_t material) {
  if (!p.materials[material].plan) throw std::runtime_error("no plan: " + p.materials[material].why_not);
  return *p.materials[material].plan;
}

TEST(ScenePlan, AMirrorImageOfASmallLightKeepsCohAndAUniformSkyNeedNot) {
  Scene lamp = plate(dull_mirror());
  lamp.lights.push_back(PointLight{.position = {0.1, 0.0, 5.0}, .intensity = flat(lamp, 10.0), .radius = 0.02});
  const ScenePlan small_light = plan_scene(lamp, 0.02, quick());
  EXPECT_TRUE(plan_of(small_light, 0).material.components.has(Effect::coh));
  EXPECT_NE(scene_plan_text(small_light, {}).find("coh kept: the mirror image of lights/0"), std::string::npos)
      << scene_plan_text(small_light, {});

  Scene sky = plate(dull_mirror());
  sky.lights.push_back(EnvironmentLight{.radiance = flat(sky, 1.0)});
  const ScenePlan uniform = plan_scene(sky, 0.02, quick());
  EXPECT_FALSE(plan_of(uniform, 0).material.components.has(Effect::coh)) << scene_plan_text(uniform, {});
  const PictureDifference d = picture_difference(render(sky, uniform.exact).picture,
                                                 render(planned_scene(sky, uniform), uniform.planned).picture);
  EXPECT_LE(d.rms_relative, 0.02);
  EXPECT_GT(d.rms_relative, 1e-4) << "something is left out";
}

// A light without size is not seen in a mirror, and one that the mirror shows elsewhere than to this camera neither.
TEST(ScenePlan, ALightThatNoMirrorShowsKeepsNothing) {
  Scene point = plate(dull_mirror());
  point.lights.push_back(PointLight{.position = {0.1, 0.0, 5.0}, .intensity = flat(point, 10.0), .radius = 0.0});
  EXPECT_FALSE(plan_of(plan_scene(point, 0.02, quick()), 0).material.components.has(Effect::coh));
  Scene aside = plate(dull_mirror());
  aside.lights.push_back(PointLight{.position = {9.0, 0.0, 3.0}, .intensity = flat(aside, 10.0), .radius = 0.02});
  EXPECT_FALSE(plan_of(plan_scene(aside, 0.02, quick()), 0).material.components.has(Effect::coh));
}

TEST(ScenePlan, ThePictureStaysWithinTheTolerance) {
  const Scene scene = five_materials();
  const Picture exact = render(scene, exact_materials(scene)).picture;
  for (const double tolerance : {0.01, 0.05}) {
    const ScenePlan p = plan_scene(scene, tolerance, quick());
    EXPECT_LE(p.predicted_error, tolerance);
    const Picture planned = render(planned_scene(scene, p), p.planned).picture;
    EXPECT_LE(picture_difference(exact, planned).rms_relative, tolerance) << scene_plan_text(p, {});
  }
}

TEST(ScenePlan, TheSamePlanWhateverTheThreadsAndTheClock) {
  const Scene scene = five_materials();
  const ScenePlan once = plan_scene(scene, 0.02, quick());
  const ScenePlan again = plan_scene(scene, 0.02, quick());
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    EXPECT_EQ(once.planned[m].material, again.planned[m].material);
  }
  EXPECT_EQ(once.predicted_error, again.predicted_error);
  EXPECT_EQ(once.bounces.planned, again.bounces.planned);
}

// Nothing meets a lone ball's light again; between two facing walls much does.
TEST(ScenePlan, OnlyAsManyReflectionsAsThePictureNeeds) {
  Scene ball = scene_of(lambertian(0.8));
  ball.objects.push_back({Sphere{}, 0});
  ball.lights.push_back(DirectionalLight{.direction = {0.0, 1.0, -1.0}, .irradiance = flat(ball, 1.0)});
  ball.image.width = ball.image.height = 32;
  ball.image.max_bounces = 4;
  const ScenePlan alone = plan_scene(ball, 0.01, quick());
  EXPECT_EQ(alone.bounces.planned, 1);
  EXPECT_EQ(alone.bounces.change, 0.0);
  EXPECT_NE(scene_plan_text(alone, {}).find("light after 1 reflection left out, of 4"), std::string::npos);

  Scene walls = scene_of(lambertian(0.8));
  walls.objects.push_back({Plane{.point = {0.0, 0.0, 0.0}, .normal = {0.0, 0.0, 1.0}, .half_size = 2.0}, 0});
  walls.objects.push_back({Plane{.point = {0.0, 2.0, 0.0}, .normal = {0.0, -1.0, 0.0}, .half_size = 2.0}, 0});
  walls.lights = ball.lights;
  walls.image = ball.image;
  walls.image.max_bounces = 2;
  EXPECT_EQ(plan_scene(walls, 0.01, quick()).bounces.planned, 2);
}

// A tolerance that single precision cannot keep leaves the exact terms in double precision.
TEST(ScenePlan, AToleranceBeyondSinglePrecisionLeavesAllAsItIs) {
  Scene scene = plate(dull_mirror());
  scene.lights.push_back(PointLight{.position = {0.1, 0.0, 5.0}, .intensity = flat(scene, 10.0), .radius = 0.0});
  const ScenePlan p = plan_scene(scene, 1e-9, quick());
  EXPECT_FALSE(p.materials[0].plan.has_value());
  EXPECT_EQ(p.materials[0].why_not, "nothing simpler stays within the tolerance");
  EXPECT_FALSE(p.planned[0].single_precision);
  EXPECT_EQ(p.predicted_error, 0.0);
}

TEST(ScenePlan, WhatIsNotSeenOrHasNoTermsStaysAsItIs) {
  Scene scene = scene_of(lambertian(0.5));
  Material peer;
  peer.name = peer.model = "lambert";
  peer.channels = scene.materials[0].material.channels;
  peer.channels[0].k = {};
  peer.channels[0].peer_k = {{"k_d", 0.5}};
  scene.materials.push_back({"peer", {}, peer});
  scene.materials.push_back({"hidden", {}, lambertian(0.3)});
  scene.objects.push_back({Sphere{}, 0});
  scene.objects.push_back({Sphere{.center = {3.0, 0.0, 0.0}, .radius = 1.0}, 1});
  scene.objects.push_back({Sphere{.center = {0.0, -50.0, 0.0}, .radius = 1.0}, 2});
  scene.lights.push_back(DirectionalLight{.direction = {0.0, 1.0, -1.0}, .irradiance = flat(scene, 1.0)});
  scene.image.width = scene.image.height = 24;
  const ScenePlan p = plan_scene(scene, 0.01, quick());
  EXPECT_TRUE(p.materials[0].plan.has_value());
  EXPECT_NE(p.materials[1].why_not.find("the model lambert has no effects"), std::string::npos);
  EXPECT_EQ(p.materials[2].why_not, "no light comes from it to the camera");
  EXPECT_EQ(p.planned[1].material, peer);
  EXPECT_NE(error_message([&] { (void)plan_scene(scene, 0.0); }).find("expected a number between 0 and 1"),
            std::string::npos);
}

// What the survey says that a small change of a material does is what it does: of direct light, light that is reflected
// twice, and light from a mirror.
TEST(Survey, WeightsAreTheDerivativesOfThePicture) {
  Scene scene = scene_of(single_channel(dull_mirror()));
  scene.materials.push_back({"wall", {}, in_channels_of(scene.materials[0].material, garnet_red_paint_13())});
  scene.objects.push_back({Plane{}, 0});
  scene.objects.push_back({Sphere{.center = {0.0, 0.0, 1.2}, .radius = 1.0}, 1});
  scene.lights.push_back(PointLight{.position = {3.0, -4.0, 5.0}, .intensity = flat(scene, 50.0), .radius = 0.3});
  scene.lights.push_back(EnvironmentLight{.radiance = flat(scene, 0.2)});
  scene.camera = {.position = {0.0, -8.0, 3.0}, .look_at = {0.0, 0.0, 0.6}, .fov_deg = 30.0};
  scene.image.width = scene.image.height = 24;
  scene.image.max_bounces = 3;
  const SurveySettings settings{.pixels = 576, .samples = 4, .most_vertices = 10000000};
  const SceneSurvey s = survey(scene, given_materials(scene), settings);
  for (std::size_t m = 0; m < 2; ++m) {
    // All values of the material grow by a ten-thousandth.
    constexpr double growth = 1e-4;
    std::vector<RenderMaterial> grown = given_materials(scene);
    MaterialChannel& c = grown[m].material.channels[0];
    for (const Coefficient k : {Coefficient::k_dd, Coefficient::k_uds, Coefficient::k_fs}) {
      if (c.coefficient(k)) *c.coefficient(k) *= 1.0 + growth;
    }
    Material rest = scene.materials[m].material;
    rest.components.erase(Effect::coh);
    const Evaluator evaluator(rest);
    const Evaluator whole(scene.materials[m].material);
    std::vector<double> change(s.radiance.size(), 0.0);
    const auto add = [&](const PathFactors& f, bool mirror) {
      for (std::size_t i = 0; i < f.size(); ++i) {
        const DirectionBatch& d = f.directions;
        const Pair pair = make_pair(Direction{d.l_x[i], d.l_y[i], d.l_z[i]}, Direction{d.v_x[i], d.v_y[i], d.v_z[i]});
        const double value = mirror ? whole.value(pair, 0, Effect::coh) * pair.cos_i * whole.material().solid_angle_sr
                                    : evaluator.value(pair, 0);
        change[f.pixel[i]] += f.weights[i] * growth * value;
      }
    };
    add(s.materials[m].lobes, false);
    add(s.materials[m].mirrors, true);
    Scene small = in_small(scene, settings.pixels, settings.samples, 0);
    small.image.seed = s.seed;
    const Picture after = render(small, grown).picture;
    double most = 0.0;
    for (std::size_t p = 0; p < change.size(); ++p) {
      const double measured = after.radiance[p] - s.radiance[p];
      EXPECT_NEAR(change[p], measured, 2e-3 * std::fabs(measured) + 1e-9 * s.radiance[p]) << "pixel " << p;
      most = std::max(most, std::fabs(measured));
    }
    EXPECT_GT(most, 0.0);
  }
}

}  // namespace
}  // namespace goniofit::test
