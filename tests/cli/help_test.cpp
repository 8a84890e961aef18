// What the program says of itself.

#include <nlohmann/json.hpp>

#include "cli/program_test.h"

namespace goniofit::test {
namespace {

const std::vector<std::string> commands{"inspect", "fit", "simulate", "eval", "verify", "export", "models"};

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
      {{"verify"}, "nothing to verify"},
      {{"verify", "--random", "3", "--trials", "0"}, "--trials"},
      {{"export", "m.json", "--format", "merl"}, "--format: \"merl\", expected csv, json or exr"},
      {{"export", "m.json", "--format", "exr"}, "needs a file"},
      {{"export", "a.json", "b.json", "--format", "json"}, "holds one material"},
      {{"export", "a.json", "--format", "exr", "-o", "a.exr", "--size", "0"}, "--size"},
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
  EXPECT_EQ(effects, (std::vector<std::string>{"coh", "dd", "udf", "uds", "fs"}));
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

}  // namespace
}  // namespace goniofit::test
