// tradeoff and plan as a user runs them.

#include <nlohmann/json.hpp>

#include "brdf/evaluator.h"
#include "cli/program_test.h"

namespace goniofit::test {
namespace {

using Json = nlohmann::json;

class Cost : public ProgramTest {
 protected:
  void SetUp() override {
    Material one_channel = ground_glass_41();
    one_channel.channels.resize(1);
    add("m.json", to_json(one_channel));
  }
};

// What scripts read: INTERFACE's keys, each of its type.
void expect_rows(const Json& document) {
  EXPECT_TRUE(document.at("machine").is_string());
  EXPECT_TRUE(document.at("instruction_set").is_string());
  EXPECT_TRUE(document.at("reference").is_string());
  for (const Json& row : document.at("rows")) {
    for (const char* key : {"name", "group", "material"}) EXPECT_TRUE(row.at(key).is_string()) << key;
    for (const char* key :
         {"ns_per_evaluation", "ns_min", "ns_max", "l1_error", "rms_relative_error", "max_relative_error"}) {
      EXPECT_TRUE(row.at(key).is_number()) << key;
    }
    EXPECT_TRUE(row.at("pareto").is_boolean());
    EXPECT_TRUE(row.at("effects").is_array());
    EXPECT_TRUE(row.at("terms").is_null() || row.at("terms").at("fresnel").is_string());
  }
}

TEST_F(Cost, TradeoffOfOneMaterial) {
  const Outcome json = run_here({"tradeoff", "m.json", "--quick", "--groups", "model,shadowing,effects,fit", "--peers",
                                 "lambert,ward", "--json", "-o", "t.json", "--plot", "p.svg", "--plot", "p.png"});
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(json.err, "") << "no progress but on a terminal";
  const Json document = Json::parse(json.out);
  expect_rows(document);
  EXPECT_EQ(Json::parse(content("t.json")), document);
  EXPECT_EQ(document.at("reference"), "he-torrance-series, exact terms");
  std::map<std::string, std::size_t> groups;
  for (const Json& row : document.at("rows")) ++groups[row.at("group")];
  EXPECT_EQ(groups, (std::map<std::string, std::size_t>{{"model", 14}, {"shadowing", 5}, {"effects", 3}, {"fit", 8}}));
  for (const Json& row : document.at("rows")) {
    EXPECT_EQ(row.contains("fit_ms"), row.at("group") == "fit");
    EXPECT_EQ(row.contains("gain"), row.at("group") == "shadowing");
  }
  EXPECT_NE(content("p.svg").find("he-torrance-series"), std::string::npos);
  EXPECT_NE(content("p.svg").find("ns per evaluation"), std::string::npos);
  EXPECT_EQ(content("p.png").substr(1, 3), "PNG");
}

TEST_F(Cost, TradeoffAsTables) {
  const Outcome text = run_here({"tradeoff", "m.json", "--quick", "--groups", "fresnel,effects"});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* words : {"fresnel: Aluminium-Coated Ground Glass #41", "errors against Fresnel's formula",
                            "effects: Aluminium-Coated Ground Glass #41", "dd+udf", "x exact", "gain"}) {
    EXPECT_NE(text.out.find(words), std::string::npos) << words << " in\n" << text.out;
  }
}

TEST_F(Cost, ThePapersSamplesNeedNoFile) {
  const Outcome json = run_here({"tradeoff", "--quick", "--groups", "fresnel", "--json"});
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(Json::parse(json.out).at("rows").size(), 4U * 3U);
}

TEST_F(Cost, PlanWritesAMaterial) {
  add_material("paint.json");
  const Outcome plan = run_here(
      {"plan", "paint.json", "--tolerance", "0.1", "--max-theta", "60", "--quick", "--json", "-o", "planned.json"});
  ASSERT_EQ(plan.status, 0) << plan.err;
  const Json document = Json::parse(plan.out);
  EXPECT_LE(document.at("worst_l1_bound").get<double>(), 0.1);
  EXPECT_EQ(document.at("domain").at("theta_i_deg"), (Json{0.0, 60.0}));
  EXPECT_EQ(document.at("domain").at("theta_r_max_deg"), 60.0);
  EXPECT_GT(document.at("lines").size(), 4U);
  for (const Json& line : document.at("lines")) {
    EXPECT_TRUE(line.at("text").is_string());
    EXPECT_TRUE(line.at("change").is_number());
    EXPECT_TRUE(line.at("saves").is_number());
  }
  const Material planned = read_material(folder_ / "planned.json");
  EXPECT_EQ(planned.channels, garnet_red_paint_13().channels);
  add("d.csv", "theta_i,theta_r\n30,30\n");
  EXPECT_EQ(run_here({"eval", "planned.json", "d.csv"}).status, 0);
  EXPECT_EQ(run_here({"simulate", "planned.json", "--sampling", "incidence-plane", "-o", "s.csv"}).status, 0);
}

TEST_F(Cost, PlanExplainsItself) {
  const Outcome plan = run_here({"plan", "m.json", "--tolerance", "0.2", "--theta-i", "0,30", "--quick"});
  ASSERT_EQ(plan.status, 0) << plan.err;
  for (const char* words : {"within 20 % on incidence 0 to 30°", "dd kept: leaving it out would change", "saves",
                            "combinations", "ns an evaluation, "}) {
    EXPECT_NE(plan.out.find(words), std::string::npos) << words << " in\n" << plan.out;
  }
}

TEST_F(Cost, PlanTakesTheDomainOfAScan) {
  add_material("paint.json");
  add_scan();
  const Outcome plan =
      run_here({"plan", "paint.json", "--tolerance", "0.2", "--scan", "scan.csv", "--quick", "--json"});
  ASSERT_EQ(plan.status, 0) << plan.err;
  const Json domain = Json::parse(plan.out).at("domain");
  EXPECT_EQ(domain.at("theta_i_deg"), (Json{15.0, 75.0}));
  EXPECT_EQ(domain.at("theta_r_max_deg"), 85.0);
}

TEST_F(Cost, BadUsageIsStatus2AndWritesNothing) {
  Material peer = anisotropic_ggx();
  add("peer.json", to_json(peer));
  add("broken.json", "{");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"tradeoff", "absent.json"}, "absent.json"},
      {{"tradeoff", "broken.json"}, "broken.json"},
      {{"tradeoff", "peer.json"}, "/model: \"ggx-anisotropic\" has no terms"},
      {{"tradeoff", "--groups", "models"}, "--groups: no group \"models\", expected model, fresnel"},
      {{"tradeoff", "--peers", "phong"}, "\"phong\" is no peer"},
      {{"tradeoff", "--plot", "p.pdf"}, ".svg or .png"},
      {{"tradeoff", "--rounds", "0"}, "--rounds"},
      {{"tradeoff", "--instructions", "MMX"}, "--instructions: \"MMX\", expected SSE2, AVX2 or AVX-512"},
      {{"tradeoff", "m.json", "-o", "m.json"}, "m.json"},
      {{"plan", "m.json"}, "--tolerance is required"},
      {{"plan", "m.json", "--tolerance", "0"}, "--tolerance: 0, expected"},
      {{"plan", "m.json", "--tolerance", "nan"}, "--tolerance"},
      {{"plan", "m.json", "--tolerance", "1.5"}, "--tolerance: 1.5"},
      {{"plan", "peer.json", "--tolerance", "0.1"}, "has no terms"},
      {{"plan", "m.json", "--tolerance", "0.1", "--theta-i", "30"}, "--theta-i"},
      {{"plan", "m.json", "--tolerance", "0.1", "--theta-i", "60,30"}, "incidence from 60 to 30 degrees"},
      {{"plan", "m.json", "--tolerance", "0.1", "--max-theta", "0"}, "degrees"},
      {{"plan", "m.json", "--tolerance", "0.1", "--wavelengths", "0.9"}, "wavelength 0.9 um"},
      {{"plan", "m.json", "--tolerance", "0.1", "--solid-angle", "9"}, "solid angle 9 sr"},
      {{"plan", "m.json", "--tolerance", "0.1", "--terms-to", "0.5"}, "--terms-to"},
      {{"plan", "m.json", "--tolerance", "0.1", "--scan", "absent.csv"}, "absent.csv"},
      {{"plan", "m.json", "--tolerance", "0.1", "-o", "m.json"}, "m.json"},
  };
  const std::vector<std::string> before = files();
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = run_here(arguments);
    const std::string words = arguments.front() + " ... " + arguments.back();
    EXPECT_EQ(outcome.status, 2) << words << ": " << outcome.err;
    EXPECT_EQ(outcome.out, "") << words;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << words << ": " << outcome.err;
    EXPECT_EQ(files(), before) << words;
  }
}

}  // namespace
}  // namespace goniofit::test
