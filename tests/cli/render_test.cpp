// goniofit render: pictures come out whole, the same for any number of threads; bad scenes end with status 2.

#include <nlohmann/json.hpp>

#include "cli/program_test.h"

namespace goniofit::test {
namespace {

const std::string scene_head =
    "[camera]\nposition = [0, -5, 1]\nlook_at = [0, 0, 0]\n[image]\nwidth = 40\nheight = 30\nsamples = 2\n"
    "[materials]\npaint = {file = \"m.json\"}\nfloor = {reflectance = 0.5}\n";
const std::string floor_object =
    "[[objects]]\ntype = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 1]\nmaterial = \"floor\"\n";
const std::string ball = "[[objects]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"paint\"\n";
const std::string lamp = "[[lights]]\ntype = \"point\"\nposition = [0, -5, 5]\nintensity = 10\n";

class Render : public ProgramTest {
 protected:
  void SetUp() override { add_material(); }
};

TEST_F(Render, AScenesPictureIsTheSameForAnyNumberOfThreads) {
  add("s.toml", scene_head + floor_object + ball + lamp);
  for (const char* const threads : {"1", "2", "3"}) {
    const std::string n = threads;
    const Outcome outcome = run_here({"render", "s.toml", "-o", n + ".png", "--threads", n});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("40 x 30 pixels in "), std::string::npos) << outcome.out;
    EXPECT_EQ(run_here({"render", "s.toml", "-o", n + ".exr", "--threads", n}).status, 0);
  }
  EXPECT_EQ(content("1.png").substr(0, 4), "\x89PNG");
  EXPECT_EQ(content("1.png"), content("2.png"));
  EXPECT_EQ(content("1.png"), content("3.png"));
  EXPECT_EQ(content("1.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(content("1.exr"), content("2.exr"));
  EXPECT_EQ(content("1.exr"), content("3.exr"));
  EXPECT_EQ(run_here({"render", "s.toml", "-o", "seed.png", "--seed", "5"}).status, 0);
  EXPECT_NE(content("1.png"), content("seed.png"));
}

TEST_F(Render, JsonCountsWhatWasDone) {
  add("s.toml", scene_head + floor_object + ball + lamp);
  const Outcome outcome = run_here({"render", "s.toml", "-o", "p.png", "--json", "--samples", "3", "--size", "60"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("width"), 80);
  EXPECT_EQ(json.at("height"), 60);
  EXPECT_EQ(json.at("rays").at("camera"), 80 * 60 * 3);
  EXPECT_GT(json.at("rays").at("shadow"), 1000);
  EXPECT_GT(json.at("evaluations"), 1000);
  EXPECT_TRUE(json.at("notes").empty());
}

TEST_F(Render, MaterialsStandOnSpheresSideBySide) {
  const Outcome outcome =
      run_here({"render", "m.json", "m.json", "--models", "given,lambert,dd+uds", "--size", "20", "-o", "p.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("from left to right: Garnet Red Paint #13 | Garnet Red Paint #13: lambert | ", 0), 0U)
      << outcome.out;
  EXPECT_NE(outcome.out.find("120 x 20 pixels"), std::string::npos) << outcome.out;
}

TEST_F(Render, AMirrorSaysWhichLightItDoesNotShow) {
  add("a.json", to_json(smooth_aluminium_45()));
  std::string head = scene_head;
  head.replace(head.find("m.json"), 6, "a.json");
  add("s.toml", head + ball + lamp);
  const Outcome outcome = run_here({"render", "s.toml", "-o", "p.png"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: lights/0 has no size: the mirror component (coh) of paint does not show it"),
            std::string::npos)
      << outcome.out;
}

struct Bad {
  std::string what, scene, message;
};

TEST_F(Render, BadScenesAreRefusedInOneLine) {
  const auto mesh = [](const std::string& file) {
    return "[[objects]]\ntype = \"mesh\"\nfile = \"" + file + "\"\nmaterial = \"floor\"\n";
  };
  add("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 1\nf 1 2 4\nf 1 2 3\n");
  add("text.obj", "this is no mesh\n");
  const std::string dark = "[[lights]]\ntype = \"point\"\nposition = [0, -5, 5]\nintensity = 0\n";
  std::string unknown = ball, inside = scene_head, none = scene_head;
  unknown.replace(unknown.find("paint"), 5, "varnish");
  inside.replace(inside.find("[0, -5, 1]"), 10, "[0, 0.5, 0]");
  none.replace(none.find("m.json"), 6, "none.json");
  const std::vector<Bad> cases{
      {"missing mesh", scene_head + mesh("none.obj") + lamp, "none.obj"},
      {"degenerate triangle", scene_head + mesh("flat.obj") + lamp, "flat.obj:6: the face is degenerate"},
      {"malformed mesh", scene_head + mesh("text.obj") + lamp, "text.obj:1: \"this\" is no record of an OBJ file"},
      {"unknown material", scene_head + unknown + lamp, "s.toml: /objects/0/material: \"varnish\" is no material"},
      {"missing material", none + ball + lamp, "none.json"},
      {"zero light", scene_head + ball + dark, "s.toml: /lights: none of them shines"},
      {"no light", scene_head + ball, "s.toml: /lights: is missing"},
      {"camera inside an object", inside + ball + lamp, "s.toml: /camera/position: is inside objects/0"},
      {"no objects", scene_head + lamp, "s.toml: /objects: is missing"},
      {"broken syntax", scene_head + "[[objects", "s.toml:"},
  };
  const std::vector<std::string> before = [&] {
    add("s.toml", "");
    return files();
  }();
  for (const Bad& bad : cases) {
    add("s.toml", bad.scene);
    for (const char* const picture : {"p.png", "p.exr"}) {
      const Outcome outcome = run_here({"render", "s.toml", "-o", picture});
      EXPECT_EQ(outcome.status, 2) << bad.what;
      EXPECT_EQ(outcome.out, "") << bad.what;
      EXPECT_NE(outcome.err.find(bad.message), std::string::npos) << bad.what << ": " << outcome.err;
      EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << bad.what << ": one line, " << outcome.err;
    }
    EXPECT_EQ(files(), before) << bad.what;
  }
}

TEST_F(Render, AToleranceMakesAPlanThatThePictureCarries) {
  add("s.toml", scene_head + floor_object + ball + lamp);
  const Outcome planned = run_here({"render", "s.toml", "--tolerance", "0.02", "-o", "planned.exr"});
  ASSERT_EQ(planned.status, 0) << planned.err;
  EXPECT_NE(planned.out.find("predicted error of the image"), std::string::npos) << planned.out;
  EXPECT_NE(planned.out.find("dd kept: leaving it out would change"), std::string::npos) << planned.out;
  EXPECT_NE(content("planned.exr").find("goniofit.plan"), std::string::npos);
  EXPECT_NE(content("planned.exr").find("dd kept"), std::string::npos);
  add("t.toml", scene_head + "[plan]\ntolerance = 0.02\n" + floor_object + ball + lamp);
  EXPECT_NE(run_here({"render", "t.toml", "-o", "t.png"}).out.find("predicted error"), std::string::npos);
  const Outcome given = run_here({"render", "t.toml", "--effects", "given", "-o", "given.png"});
  EXPECT_EQ(given.out.find("predicted error"), std::string::npos);
}

TEST_F(Render, ComparesThePlanWithAllEffectsAndWithThePublishedTerms) {
  add("s.toml", scene_head + floor_object + ball + lamp);
  const Outcome outcome = run_here({"render", "s.toml", "--tolerance", "0.02", "--compare", "--json", "-o", "p.exr"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const auto& comparison = json.at("comparison");
  EXPECT_LE(comparison.at("difference").at("rms_relative"), 0.02);
  EXPECT_GT(comparison.at("published_difference").at("rms_relative"), comparison.at("difference").at("rms_relative"));
  EXPECT_GT(comparison.at("all_effects_ratio").at("median"), 0.3);
  EXPECT_LE(comparison.at("seconds").at("min"), comparison.at("seconds").at("median"));
  EXPECT_EQ(json.at("plan").at("tolerance"), 0.02);
  EXPECT_NE(content("p.exr").find("goniofit.comparison"), std::string::npos);
}

TEST_F(Render, PlanTakesAScene) {
  add("s.toml", scene_head + floor_object + ball + lamp);
  const Outcome outcome = run_here({"plan", "s.toml", "--tolerance", "0.02", "--json", "-o", "planned.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(nlohmann::json::parse(content("planned.json")), json);
  ASSERT_EQ(json.at("materials").size(), 2U);
  for (const auto& material : json.at("materials")) {
    if (material.at("name") != "paint") continue;
    EXPECT_LE(material.at("planned").at("worst_l1_error"), 0.02);
    add("one.json", material.at("material").dump());
    EXPECT_EQ(run_here({"export", "one.json", "--format", "json", "-o", "two.json"}).status, 0)
        << "a material that every other command takes";
  }
  EXPECT_NE(
      run_here({"plan", "s.toml", "--tolerance", "0.02", "--max-theta", "70"}).err.find("--max-theta: a scene says"),
      std::string::npos);
}

TEST_F(Render, BadUsage) {
  add("s.toml", scene_head + ball + lamp);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"s.toml"}, "--output is required"},
      {{"s.toml", "-o", "p.jpg"}, "p.jpg: a picture needs a name that ends in .exr or .png"},
      {{"s.toml", "m.json", "-o", "p.png"}, "one scene at a time"},
      {{"s.toml", "-o", "p.png", "--models", "given"}, "--models shows a material's models"},
      {{"s.toml", "-o", "p.png", "--size", "0"}, "--size: 0"},
      {{"s.toml", "-o", "p.png", "--samples", "0"}, "--samples: 0"},
      {{"s.toml", "-o", "p.png", "--exposure", "bright"}, "--exposure"},
      {{"m.json", "-o", "p.png", "--models", "phong"}, "\"phong\" is no model and names no effects"},
      {{"m.json", "-o", "p.png", "--models", "coh"}, "\"coh\" is no model and names no effects"},
      {{"m.json", "-o", "p.png", "--light-angle", "181"}, "--light-angle: 181"},
      {{"m.json", "-o", "p.png", "--sky", "-1"}, "--sky: -1"},
      {{"m.json", "-o", "p.png", "--compare"}, "--compare are of scenes"},
      {{"s.toml", "-o", "p.png", "--effects", "some"}, "--effects: \"some\""},
      {{"s.toml", "-o", "p.png", "--effects", "all", "--compare"}, "--compare compares a plan"},
      {{"s.toml", "-o", "p.png", "--tolerance", "2"}, "tolerance 2: expected a number between 0 and 1"},
      {{"none.toml", "-o", "p.png"}, "none.toml"},
      {{"none.json", "-o", "p.png"}, "none.json"},
  };
  for (const auto& [arguments, message] : cases) {
    std::vector<std::string> all{"render"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run_here(all);
    EXPECT_EQ(outcome.status, 2) << message;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << message << ": " << outcome.err;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"m.json", "s.toml"}));
  EXPECT_EQ(run_here({"render", "s.toml", "-o", "nowhere/p.png"}).status, 3);
}

}  // namespace
}  // namespace goniofit::test
