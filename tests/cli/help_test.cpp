// What the program says of itself.

#include <nlohmann/json.hpp>
#include <set>

#include "cli/program_test.h"
#include "peers/peers.h"

namespace goniofit::test {
namespace {

const std::vector<std::string> commands{"inspect", "fit",    "compare", "simulate", "eval",   "verify", "tradeoff",
                                        "plan",    "render", "export",  "report",   "curves", "models"};

TEST(Help, NamesEveryCommand) {
  const Outcome help = goniofit({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string& command : commands)
    EXPECT_NE(help.out.find("  " + command + " "), std::string::npos) << command;
}

TEST(Help, EveryCommandHasAnExampleOfItself) {
  for (const std::string& command : commands) {
    const Outcome help = goniofit({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_NE(help.out.find("Example:\n  goniofit " + command), std::string::npos) << help.out;
    EXPECT_EQ(help.err, "") << command;
  }
}

TEST(Help, FitNamesWhatItSaysBesideTheReport) {
  const Outcome help = goniofit({"fit", "--help"});
  for (const char* const flag : {"--profile ", "--profile-plot ", "--residual-plot ", "--report "})
    EXPECT_NE(help.out.find(flag), std::string::npos) << help.out;
}

TEST(Help, Version) {
  const Outcome version = goniofit({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("goniofit ", 0), 0U);
}

TEST(Usage, BadUsageIsStatus2WithNothingOnStandardOutput) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "no command, expected inspect, fit"},
      {{"ftt"}, "no command \"ftt\", expected inspect, fit"},
      {{"--bogus"}, ""},
      {{"fit", "--bogus", "x"}, "--bogus"},
      {{"fit"}, "no scan"},
      {{"inspect"}, "SCAN is required"},
      {{"inspect", "a.csv", "b.csv"}, "b.csv"},
      {{"simulate", "m.json"}, "--sampling is required"},
      {{"simulate", "m.json", "--sampling", "sphere"},
       "--sampling: \"sphere\", expected incidence-plane or hemisphere"},
      {{"simulate", "m.json", "--sampling", "hemisphere", "--noise", "-0.1"}, "--noise"},
      {{"simulate", "m.json", "--sampling", "hemisphere", "--noise", "1,2,3"}, "--noise"},
      {{"simulate", "m.json", "--sampling", "hemisphere", "--seed", "x"}, "--seed"},
      {{"simulate", "m.json", "--sampling", "hemisphere", "--phi-i", "0,x"}, "--phi-i: \"x\" is not a finite number"},
      {{"compare"}, "no scan"},
      {{"compare", "s.csv", "--plot", "p.pdf"}, "--plot: a picture needs"},
      {{"verify"}, "nothing to verify"},
      {{"verify", "--random", "3", "--trials", "0"}, "--trials"},
      {{"export", "m.json", "--format", "merl"}, "--format: \"merl\", expected csv, json or exr"},
      {{"export", "m.json", "--format", "exr"}, "needs a file"},
      {{"export", "a.json", "b.json", "--format", "json"}, "holds one material"},
      {{"export", "a.json", "--format", "exr", "-o", "a.exr", "--size", "0"}, "--size"},
      {{"report", "m.json"}, "SCAN is required"},
      {{"report", "m.json", "s.csv"}, "--output is required"},
      {{"fit", "s.csv", "--report", "-"}, "--report: a page needs a file name"},
      {{"models", "extra"}, "extra"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = goniofit(arguments);
    const std::string words = arguments.empty() ? "no arguments" : arguments.front() + " ... " + arguments.back();
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_EQ(outcome.out, "") << words;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << words << ": " << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << words;
  }
}

TEST(Models, TextAndJsonHoldTheSameNames) {
  const Outcome text = goniofit({"models"});
  const Outcome json = goniofit({"models", "--json"});
  EXPECT_EQ(text.status, 0);
  EXPECT_EQ(json.status, 0);
  EXPECT_EQ(text.out.find('\x1b'), std::string::npos) << "no colour but on a terminal";
  const auto model = nlohmann::json::parse(json.out).at("models").at(0);
  std::vector<std::string> effects;
  for (const auto& effect : model.at("effects")) effects.push_back(effect.at("name"));
  EXPECT_EQ(effects, (std::vector<std::string>{"coh", "dd", "udf", "uds", "fs", "rough"}));
  for (const auto& p : model.at("parameters")) {
    EXPECT_NE(text.out.find("  " + p.at("name").get<std::string>() + " "), std::string::npos) << p;
  }
  for (const char* term : {"fresnel", "shadowing", "effective_roughness", "distribution"}) {
    int defaults = 0;
    for (const auto& tier : model.at("terms").at(term)) defaults += tier.at("default").get<bool>() ? 1 : 0;
    EXPECT_EQ(defaults, 1) << term;
  }
  EXPECT_EQ(model.at("parameters").at(0).at("min"), 1e-4);
  EXPECT_EQ(model.at("parameters").at(0).at("max"), 10.0);
}

TEST(Models, EveryNameThatFilesAcceptIsTold) {
  const std::string text = goniofit({"models"}).out;
  const auto model = nlohmann::json::parse(goniofit({"models", "--json"}).out).at("models").at(0);
  const auto told = [&](const std::string& term) {
    std::set<std::string> names;
    for (const auto& tier : model.at("terms").at(term)) names.insert(tier.at("name"));
    return names;
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(told("shadowing"), (Names{"li-torrance", "smith", "schlick", "none"}));
  EXPECT_EQ(told("effective_roughness"), (Names{"li-torrance", "he", "none"}));
  EXPECT_EQ(told("distribution"), (Names{"rough-limit", "he-torrance", "he-torrance-series", "student-t"}));
  EXPECT_EQ(told("rough"), (Names{"functional", "integral", "qualitative"}));
  EXPECT_EQ(told("anisotropy"), (Names{"consistent", "printed"}));
  for (const PeerInfo& peer : peer_catalogue()) {
    EXPECT_NE(text.find("  " + std::string(peer.name) + " "), std::string::npos) << peer.name;
  }
}

TEST(Models, APeerTellsItsParametersAndBounds) {
  const auto models = nlohmann::json::parse(goniofit({"models", "--json"}).out).at("models");
  ASSERT_EQ(models.size(), 1 + peer_catalogue().size());
  const auto& blinn = models.at(2);
  EXPECT_EQ(blinn.at("name"), "blinn-phong");
  EXPECT_EQ(blinn.at("reads_fresnel"), false);
  const auto& exponent = blinn.at("parameters").at(0);
  EXPECT_EQ(exponent.at("name"), "exponent");
  EXPECT_EQ(exponent.at("scope"), "shared");
  EXPECT_EQ(exponent.at("max"), 1e6);
  const auto& specular = blinn.at("parameters").at(2);
  EXPECT_EQ(specular.at("name"), "k_s");
  EXPECT_EQ(specular.at("scope"), "channel");
  EXPECT_TRUE(specular.at("max").is_null());
}

}  // namespace
}  // namespace goniofit::test
