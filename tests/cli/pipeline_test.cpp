// The commands one after another, as a user chains them.

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "brdf/evaluator.h"
#include "cli/program_test.h"
#include "io/exr_table.h"

namespace goniofit::test {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

class Pipeline : public ProgramTest {
 protected:
  void SetUp() override { add_material(); }
  void must(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run_here(arguments);
    ASSERT_EQ(outcome.status, 0) << arguments.front() << ": " << outcome.err;
  }
};

TEST_F(Pipeline, SimulateFitEvalExport) {
  must({"simulate", "m.json", "--sampling", "hemisphere", "--noise", "0.02", "--seed", "7", "-o", "s.csv"});
  must({"inspect", "s.csv"});
  must({"fit", "s.csv", "--components", "dd,uds,fs", "-o", "f.json", "--table", "t.csv", "--plot", "p.svg", "--plot",
        "p.png"});
  const Material truth = garnet_red_paint_13();
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_NEAR(fitted.surface.slope.value(), truth.surface.slope.value(), 0.01 * truth.surface.slope.value());
  ASSERT_TRUE(fitted.fit);
  EXPECT_TRUE(fitted.fit->converged);
  EXPECT_EQ(fitted.fit->samples, 8U * 441U);
  EXPECT_EQ(lines(content("t.csv")).size(), 4U) << "a header and a row a channel";

  add("d.csv", "theta_i,theta_r\n30,30\n45,-20\n");
  must({"eval", "f.json", "d.csv", "-o", "v.csv"});
  const std::vector<std::string> rows = lines(content("v.csv"));
  EXPECT_EQ(rows.at(0), "theta_i,theta_r,R,G,B");
  const Evaluator evaluator(fitted);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(std::stod(cells(rows.at(1)).at(2 + c)), evaluator.value(make_pair(in_plane(30, 30)), c)) << "17 digits";
    EXPECT_EQ(std::stod(cells(rows.at(2)).at(2 + c)), evaluator.value(make_pair(in_plane(45, -20)), c));
  }

  must({"export", "f.json", "--format", "exr", "--size", "32", "-o", "f.exr"});
  EXPECT_EQ(read_exr(folder_ / "f.exr").channels.size(), 3U);
  EXPECT_EQ(run_here({"export", "f.json", "--format", "json"}).out, content("f.json"));
  EXPECT_EQ(lines(run_here({"export", "f.json", "m.json", "--format", "csv"}).out).size(), 7U);
}

TEST_F(Pipeline, TheSameSeedGivesTheSameBytes) {
  const auto simulate = [this](const std::string& seed) {
    return run_here({"simulate", "m.json", "--sampling", "incidence-plane", "--noise", "0.02,0.001", "--seed", seed})
        .out;
  };
  EXPECT_EQ(simulate("7"), simulate("7"));
  EXPECT_NE(simulate("7"), simulate("8"));
  add("s.csv", simulate("7"));
  for (const char* name : {"a.json", "b.json"}) must({"fit", "s.csv", "-o", name});
  EXPECT_EQ(content("a.json"), content("b.json"));
  const auto verify = [this](const std::string& seed) {
    return run_here({"verify", "--random", "2", "--seed", seed, "--json"}).out;
  };
  EXPECT_EQ(verify("3"), verify("3"));
}

TEST_F(Pipeline, ARecipeRepeatsAFit) {
  add_scan("s.csv");
  add("r.toml",
      "scan = \"s.csv\"\nname = \"mine\"\ncomponents = [\"dd\", \"uds\"]\n[optics]\nn = 1.6\n[parameters]\nk_uds = "
      "0.1\n");
  must({"fit", "--recipe", "r.toml", "-o", "a.json"});
  const Material by_recipe = read_material(folder_ / "a.json");
  EXPECT_EQ(by_recipe.name, "mine");
  EXPECT_EQ(by_recipe.components, (EffectSet{Effect::dd, Effect::uds}));
  EXPECT_EQ(by_recipe.channels[0].n, 1.6) << "the recipe wins over the scan's own metadata";
  EXPECT_EQ(by_recipe.channels[0].coefficient(Coefficient::k_uds), 0.1);

  must({"fit", "--recipe", "r.toml", "--n", "1.8", "--fix", "k_uds=0.2", "--components", "dd,uds,fs", "--name", "other",
        "-o", "b.json"});
  const Material by_flags = read_material(folder_ / "b.json");
  EXPECT_EQ(by_flags.name, "other") << "a flag wins over the recipe";
  EXPECT_EQ(by_flags.components, (EffectSet{Effect::dd, Effect::uds, Effect::fs}));
  EXPECT_EQ(by_flags.channels[2].n, 1.8);
  EXPECT_EQ(by_flags.channels[2].coefficient(Coefficient::k_uds), 0.2);

  must({"fit", "s.csv", "--components", "dd,uds", "-o", "c.json"});
  EXPECT_EQ(read_material(folder_ / "c.json").channels[0].n, 1.7) << "neither: the scan's";
}

TEST_F(Pipeline, OpticalConstantsAreInterpolatedAtEachWavelength) {
  add_scan("s.csv");
  add("nk.csv", "wavelength_um,n,kappa\n0.4,1.0,2.0\n0.7,4.0,5.0\n");
  must({"fit", "s.csv", "--components", "dd,udf", "--optical-constants", "nk.csv", "-o", "a.json"});
  const Material material = read_material(folder_ / "a.json");
  EXPECT_NEAR(material.channels[0].n.value(), 3.5, 1e-12) << "0.65 um";
  EXPECT_NEAR(material.channels[2].kappa.value(), 2.5, 1e-12) << "0.45 um";
  add("r.toml", "[optics]\noptical_constants = \"nk.csv\"\n");
  must({"fit", "s.csv", "--recipe", "r.toml", "--components", "dd,udf", "-o", "b.json"});
  EXPECT_EQ(content("a.json"), content("b.json"));

  add("bare.csv", "theta_i,theta_r,R\n30,30,1\n30,20,0.5\n");
  const Outcome outcome = run_here({"fit", "bare.csv", "--optical-constants", "nk.csv"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.rfind("bare.csv: column R: no wavelength", 0), 0U) << outcome.err;
}

TEST_F(Pipeline, SeveralScansAreFittedTogether) {
  must({"simulate", "m.json", "--sampling", "incidence-plane", "-o", "a.csv"});
  must({"simulate", "m.json", "--sampling", "hemisphere", "-o", "b.csv"});
  must({"fit", "a.csv", "b.csv", "--components", "dd,uds,fs", "-o", "f.json"});
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_EQ(fitted.fit->samples, read_scan(folder_ / "a.csv").size() + read_scan(folder_ / "b.csv").size());
  EXPECT_NEAR(fitted.surface.slope.value(), garnet_red_paint_13().surface.slope.value(), 1e-6);
}

TEST_F(Pipeline, FitReportsAsJson) {
  add_scan("s.csv");
  const Outcome outcome = run_here({"fit", "s.csv", "--channels", "g", "--json"});
  EXPECT_EQ(outcome.status, 0);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(json.at("converged"));
  EXPECT_EQ(json.at("channels").size(), 1U);
  EXPECT_EQ(json.at("channels")[0].at("name"), "G");
  EXPECT_FALSE(json.at("reflectance").empty());
}

TEST_F(Pipeline, EvalKeepsTheInputAsItStood) {
  add("d.csv", "# from the lab\nnote;theta_i;phi_i;theta_r;phi_r;\nfirst;10;0;20;180;\n;30.0;0;30;90;\n");
  const Outcome outcome = run_here({"eval", "m.json", "d.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<std::string> rows = lines(outcome.out);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], "note;theta_i;phi_i;theta_r;phi_r;R;G;B");
  EXPECT_EQ(rows[1].rfind("first;10;0;20;180;0.", 0), 0U) << rows[1];
  EXPECT_EQ(rows[2].rfind(";30.0;0;30;90;0.", 0), 0U) << rows[2];
  add("t.csv", "theta_i,theta_r,note\n10,20,\n");
  EXPECT_EQ(lines(run_here({"eval", "m.json", "t.csv"}).out).at(1).rfind("10,20,,0.", 0), 0U) << "an empty field stays";
}

TEST_F(Pipeline, VerifyFailsWhereABoundIsMissed) {
  add("truth.json", to_json(garnet_red_paint_13()));
  const std::string recipe =
      "components = [\"dd\", \"uds\", \"fs\"]\n[optics]\nn = 1.7\n[verify]\ntruth = \"truth.json\"\n"
      "sampling = \"incidence-plane\"\ntrials = 6\n";
  add("good.toml", recipe + "bounds = {slope_bias = 0.5}\n");
  add("bad.toml", recipe + "bounds = {slope_bias = 1e-9}\n");
  const Outcome good = run_here({"verify", "good.toml"});
  EXPECT_EQ(good.status, 0) << good.out << good.err;
  EXPECT_NE(good.out.find("passed"), std::string::npos);
  EXPECT_NE(good.out.find("6 trials"), std::string::npos);
  const Outcome both = run_here({"verify", "good.toml", "bad.toml", "--trials", "3", "--json"});
  EXPECT_EQ(both.status, 1);
  const auto json = nlohmann::json::parse(both.out);
  EXPECT_FALSE(json.at("passed"));
  EXPECT_TRUE(json.at("recipes").at(0).at("passed"));
  EXPECT_FALSE(json.at("recipes").at(1).at("passed"));
  EXPECT_EQ(json.at("recipes").at(1).at("trials"), 3);
  EXPECT_FALSE(json.at("recipes").at(1).at("missed").empty());
}

TEST_F(Pipeline, AForeignLocaleChangesNothing) {
  add_scan("s.csv");
  must({"fit", "s.csv", "-o", "a.json"});
  ASSERT_EQ(
      run_here({"fit", "s.csv", "-o", "b.json"}, {.environment = {"LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"}}).status,
      0);
  EXPECT_EQ(content("a.json"), content("b.json"));
}

}  // namespace
}  // namespace goniofit::test
