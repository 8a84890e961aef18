// The commands one after another, as a user chains them.

#include <algorithm>
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

TEST_F(Pipeline, ReflectancesLossesAndExclusionsReachTheReport) {
  must({"simulate", "m.json", "--sampling", "incidence-plane", "--noise", "0.02,0.001", "--seed", "7",
        "--with-uncertainty", "-o", "s.csv"});
  add("dhr.csv", "theta_i,r,u_R\n8,0.12,0.002\n60,0.16,0.002\n");
  const Outcome outcome = run_here({"fit", "s.csv", "--components", "dd,uds,fs", "--loss", "log1p", "--robust", "huber",
                                    "--weight", "cosine-solid-angle", "--exclude-retro", "7", "--reflectances",
                                    "dhr.csv", "--scale-u", "0.02", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("objective").at("loss"), "log1p");
  EXPECT_EQ(json.at("objective").at("robust"), "huber");
  EXPECT_EQ(json.at("objective").at("weight"), "cosine-solid-angle");
  EXPECT_GT(json.at("left_out").at("retro_cone"), 0);
  ASSERT_EQ(json.at("reflectance_readings").size(), 2U);
  EXPECT_EQ(json.at("reflectance_readings").at(0).at("channel"), "R");
  EXPECT_EQ(json.at("uncertainty").at("from"), "readings");
  EXPECT_EQ(json.at("uncertainty").at("scale_u"), 0.02);
  add("dhr.csv", "theta_i,R\n8,12\n");
  const Outcome bad = run_here({"fit", "s.csv", "--reflectances", "dhr.csv"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("dhr.csv:2: column R: \"12\" is out of range"), std::string::npos) << bad.err;
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
  // A paint fitted as a metal is no good fit, and fails; its material is still written.
  EXPECT_EQ(
      run_here({"fit", "s.csv", "--components", "dd,udf", "--optical-constants", "nk.csv", "-o", "a.json"}).status, 1);
  const Material material = read_material(folder_ / "a.json");
  EXPECT_NEAR(material.channels[0].n.value(), 3.5, 1e-12) << "0.65 um";
  EXPECT_NEAR(material.channels[2].kappa.value(), 2.5, 1e-12) << "0.45 um";
  add("r.toml", "[optics]\noptical_constants = \"nk.csv\"\n");
  EXPECT_EQ(run_here({"fit", "s.csv", "--recipe", "r.toml", "--components", "dd,udf", "-o", "b.json"}).status, 1);
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

TEST_F(Pipeline, AModelThatCannotDescribeTheScanIsSaidAndFails) {
  std::string retro = "theta_i,theta_r,R\n";
  for (int i = 10; i <= 60; i += 10) {
    for (int r = -80; r <= 80; r += 2) {
      const double value = 0.05 + 20.0 * std::exp(-0.1 * (r + i) * (r + i));
      retro += std::to_string(i) + "," + std::to_string(r) + "," + std::to_string(value) + "\n";
    }
  }
  add("retro.csv", retro);
  const Outcome outcome = run_here({"fit", "retro.csv", "--components", "dd,uds,fs", "-o", "f.json"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("verdict       FAILS"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("retro peak"), std::string::npos) << outcome.out;
  EXPECT_EQ(read_material(folder_ / "f.json").components, (EffectSet{Effect::dd, Effect::uds, Effect::fs}));
  const Outcome json = run_here({"fit", "retro.csv", "--components", "dd,uds,fs", "--json"});
  EXPECT_EQ(json.status, 1);
  const auto diagnostics = nlohmann::json::parse(json.out).at("diagnostics");
  EXPECT_EQ(diagnostics.at("verdict"), "fails");
  EXPECT_GT(diagnostics.at("regions").at("retro").at("of_misfit"), 0.7);
  EXPECT_GT(diagnostics.at("misfit").at("peak"), 0.5);
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

TEST_F(Pipeline, APeerFromSimulationToExport) {
  add("p.json", to_json(anisotropic_ggx()));
  must({"simulate", "p.json", "--sampling", "incidence-plane", "-o", "p.csv"});
  must({"fit", "p.csv", "--model", "ggx-anisotropic", "--n", "1.6", "-o", "f.json", "--table", "t.csv", "--plot",
        "p.svg"});
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_EQ(fitted.model, "ggx-anisotropic");
  EXPECT_NEAR(fitted.parameters.at("alpha_x").value(), 0.1, 1e-6);
  EXPECT_NEAR(fitted.parameters.at("alpha_y").value(), 0.3, 1e-6);
  EXPECT_NEAR(fitted.channels[1].coefficient("k_s").value(), 0.75, 1e-6);
  add("d.csv", "theta_i,phi_i,theta_r,phi_r\n30,0,40,180\n30,90,40,270\n");
  const std::vector<std::string> rows = lines(run_here({"eval", "p.json", "d.csv"}).out);
  ASSERT_EQ(rows.size(), 3U);
  const Evaluator evaluator(anisotropic_ggx());
  EXPECT_EQ(std::stod(cells(rows[2])[4]), evaluator.value(make_pair({30, 90, 40, 270}), 0));
  EXPECT_NE(cells(rows[1])[4], cells(rows[2])[4]);
  const Outcome exr = run_here({"export", "p.json", "--format", "exr", "-o", "p.exr"});
  EXPECT_EQ(exr.status, 2);
  EXPECT_NE(exr.err.find("an anisotropic material cannot be tabulated"), std::string::npos) << exr.err;
  must({"export", "p.json", "m.json", "--format", "csv", "-o", "both.csv"});
}

TEST_F(Pipeline, NewTiersAndFormsReachTheMaterial) {
  Material m = rough_plaster();
  m.surface.slope_y = 0.15;
  add("m.json", to_json(m));
  must({"simulate", "m.json", "--sampling", "incidence-plane", "-o", "s.csv"});
  must({"fit", "s.csv", "--components", "dd,rough", "--anisotropic", "--rough-form", "functional", "--shadowing",
        "li-torrance", "-o", "f.json"});
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_NEAR(fitted.surface.slope_y.value(), 0.15, 1e-5);
  EXPECT_NEAR(fitted.surface.facet_slope_deg.value(), 25.0, 1e-3);
  EXPECT_NEAR(fitted.channels[0].coefficient(Coefficient::rho).value(), 0.82, 1e-4);
  must({"fit", "s.csv", "--components", "dd,udf", "--terms", "he-torrance", "--distribution", "rough-limit",
        "--anisotropy", "printed", "--rough-form", "qualitative", "--anisotropic", "-o", "g.json"});
  const Material other = read_material(folder_ / "g.json");
  EXPECT_EQ(other.terms, (Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he,
                                DistributionTier::rough_limit}));
  EXPECT_EQ(other.forms.rough, RoughForm::qualitative);
  EXPECT_EQ(other.forms.anisotropy, AnisotropyForm::printed);
}

TEST_F(Pipeline, LongTailsAreFitted) {
  add("m.json", to_json(long_tailed_paint()));
  must({"simulate", "m.json", "--sampling", "incidence-plane", "-o", "s.csv"});
  must({"fit", "s.csv", "--components", "dd,uds,fs", "--distribution", "student-t", "-o", "f.json"});
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_EQ(fitted.terms.distribution, DistributionTier::student_t);
  EXPECT_NEAR(fitted.surface.tail.value(), 1.8, 1e-4);
}

TEST_F(Pipeline, AFlagsModelWinsOverTheRecipes) {
  add_scan("s.csv");
  add("r.toml", "components = [\"dd\", \"uds\"]\nterms = \"he-torrance\"\n[optics]\nn = 1.7\n");
  must({"fit", "s.csv", "--recipe", "r.toml", "--model", "ggx", "-o", "f.json"});
  const Material fitted = read_material(folder_ / "f.json");
  EXPECT_EQ(fitted.model, "ggx");
  EXPECT_EQ(fitted.terms.fresnel, FresnelTier::exact) << "the one term that it has";
}

TEST_F(Pipeline, ValuesThatAreNotTheFormulasAreCounted) {
  Material m = rough_plaster();
  m.surface.facet_slope_deg = 70.0;
  add("m.json", to_json(m));
  add("d.csv", "theta_i,theta_r\n85,85\n80,84\n0,0\n");
  const Outcome cut = run_here({"eval", "m.json", "d.csv"});
  EXPECT_EQ(cut.status, 0);
  EXPECT_EQ(cut.err.rfind("m.json: warning: 2 directions where the functional form of rough is negative", 0), 0U)
      << cut.err;
  EXPECT_EQ(lines(cut.out).size(), 4U);
  const Outcome simulated = run_here({"simulate", "m.json", "--sampling", "incidence-plane", "-o", "s.csv"});
  EXPECT_NE(simulated.err.find("functional form of rough"), std::string::npos) << simulated.err;
  Material mirror = garnet_red_paint_13();
  mirror.surface = slope_alone(1e-6);
  add("m.json", to_json(mirror));
  add("d.csv", "theta_i,theta_r\n89.99999999999,89.99999999999\n0,10\n");
  const Outcome plain = run_here({"eval", "m.json", "d.csv"});
  EXPECT_EQ(plain.status, 0);
  EXPECT_EQ(plain.err.find("functional"), std::string::npos) << plain.err;
}

TEST_F(Pipeline, CompareSortsByLossAndTellsWhatWasFree) {
  add_scan("s.csv");
  const std::vector<std::string> arguments{"compare",      "s.csv",     "--n",      "1.7",
                                           "--components", "dd,uds,fs", "--models", "lambert,ggx,rough+dd,li-torrance",
                                           "--json"};
  const Outcome outcome = run_here(arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = nlohmann::json::parse(outcome.out).at("rows");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].at("model"), "li-torrance");
  EXPECT_EQ(rows[0].at("relative_loss"), 1.0);
  EXPECT_EQ(rows[0].at("free_parameters"), 10) << "slope and three coefficients a channel";
  EXPECT_EQ(rows[3].at("model"), "lambert");
  EXPECT_EQ(rows[3].at("free_parameters"), 3);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_GE(rows[i].at("loss"), rows[i - 1].at("loss"));
  // What each says is what `fit` says.
  const auto alone = nlohmann::json::parse(run_here({"fit", "s.csv", "--n", "1.7", "--model", "ggx", "--json"}).out);
  const auto ggx = std::find_if(rows.begin(), rows.end(), [](const auto& row) { return row.at("model") == "ggx"; });
  EXPECT_EQ(ggx->at("loss"), alone.at("loss"));
  auto again = nlohmann::json::parse(run_here(arguments).out).at("rows");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    again[i]["seconds"] = rows[i].at("seconds");
    EXPECT_EQ(again[i], rows[i]) << "deterministic";
  }
}

TEST_F(Pipeline, CompareDrawsAndTabulates) {
  add_scan("s.csv");
  const Outcome outcome = run_here(
      {"compare", "s.csv", "--models", "lambert,ward", "--fix", "alpha=0.2", "--plot", "c.svg", "--plot", "c.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(outcome.out.find("ward"), outcome.out.find("lambert"));
  EXPECT_NE(outcome.out.find("alpha 0.2"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("lambert has no parameter alpha and goes without its setting"), std::string::npos)
      << outcome.out;
  EXPECT_NE(content("c.svg").find(">ward<"), std::string::npos);
  EXPECT_EQ(content("c.png").substr(1, 3), "PNG");
}

TEST_F(Pipeline, CompareFreesTheIndexWhereItIsRead) {
  add_scan("s.csv");
  const auto rows =
      nlohmann::json::parse(run_here({"compare", "s.csv", "--models", "lambert,ggx", "--free", "n", "--json"}).out)
          .at("rows");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("model"), "ggx");
  EXPECT_EQ(rows[1].at("free_parameters"), 3) << "Lambert reads no n";
  std::size_t indices = 0;
  for (const auto& p : rows[0].at("parameters")) indices += p.at("name") == "n" ? 1 : 0;
  EXPECT_EQ(indices, 3U);
}

TEST_F(Pipeline, CompareRefusesWhatItCannotCompare) {
  add_scan("s.csv");
  const auto complaint = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"compare", "s.csv"});
    const Outcome outcome = run_here(flags);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  };
  EXPECT_EQ(complaint({"--models", "phong"}).rfind("model \"phong\": no such model, expected one that", 0), 0U);
  EXPECT_EQ(complaint({"--models", "ward,ward"}), "model \"ward\" is named twice\n");
  EXPECT_EQ(complaint({"--models", "ward", "--fix", "slope=1"}),
            "parameter slope: none of the models compared has it\n");
  EXPECT_EQ(complaint({"--models", "ward", "--fix", "alpha=9"}),
            "model ward: parameter alpha: value 9 is out of range, expected [0.001, 2]\n");
  add("bare.csv", "theta_i,theta_r,R\n30,30,1\n30,20,0.5\n45,45,1\n");
  const Outcome bare = run_here({"compare", "bare.csv", "--models", "he-torrance"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_EQ(bare.err.rfind("model he-torrance: distribution he-torrance needs the wavelength", 0), 0U) << bare.err;
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

TEST_F(Pipeline, VerifyIsAFunctionOfTheSeedNotOfThreads) {
  add("truth.json", to_json(garnet_red_paint_13()));
  add("r.toml",
      "components = [\"dd\", \"uds\", \"fs\"]\n[optics]\nn = 1.7\n[verify]\ntruth = \"truth.json\"\n"
      "sampling = \"incidence-plane\"\ntrials = 4\nnoise = {relative = 0.02, additive = 1e-3, known = true}\n"
      "bounds = {bias = 3.0, coverage_68 = [0.01, 0.99], coverage_95 = [0.01, 1.0]}\n");
  const auto json = [this](const std::string& threads, const std::string& seed) {
    return run_here({"verify", "r.toml", "--threads", threads, "--seed", seed, "--json"}).out;
  };
  EXPECT_EQ(json("1", "5"), json("2", "5"));
  EXPECT_NE(json("1", "5"), json("1", "6"));
  const auto parsed = nlohmann::json::parse(json("1", "5"));
  const auto& recipe = parsed.at("recipes").at(0);
  EXPECT_EQ(recipe.at("seed"), 5);
  EXPECT_TRUE(recipe.at("noise").at("known"));
  EXPECT_EQ(parsed.at("level"), 0.05);
  EXPECT_GT(parsed.at("tests"), recipe.at("parameters").size());
  EXPECT_EQ(recipe.at("parameters").at(0).at("coverage_95_limits").size(), 2U);
}

TEST_F(Pipeline, VerifyWritesAPageAndAPlot) {
  add("truth.json", to_json(garnet_red_paint_13()));
  add("r.toml",
      "components = [\"dd\", \"uds\", \"fs\"]\n[optics]\nn = 1.7\n[verify]\ntruth = \"truth.json\"\n"
      "sampling = \"incidence-plane\"\ntrials = 3\n");
  must({"verify", "r.toml", "--plot", "c.svg", "--markdown", "v.md"});
  EXPECT_NE(content("c.svg").find("k_uds"), std::string::npos);
  EXPECT_NE(content("v.md").find("| r | plane, 2 % | 0 of 3 | "), std::string::npos) << content("v.md");
  EXPECT_EQ(run_here({"verify", "r.toml", "--plot", "c.pdf"}).status, 2);
  EXPECT_EQ(run_here({"verify", "r.toml", "--markdown", "r.toml"}).status, 2);
  EXPECT_EQ(run_here({"verify", "r.toml", "--level", "2"}).status, 2);
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
