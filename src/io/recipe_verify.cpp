#include "io/recipe_verify.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/recipe_parameters.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {
namespace {

constexpr std::int64_t most_trials = 1'000'000;

std::filesystem::path read_truth(const TomlValue& table, const std::filesystem::path& recipe) {
  const std::string expected = "the path of a material";
  const auto truth = table.find("truth");
  if (!truth) throw key_error(table.source(), table.pointer() + "/truth", "is missing, expected " + expected);
  const std::string& path = truth->text(expected);
  if (path.empty()) truth->fail("is empty, expected " + expected);
  return (recipe.parent_path() / path).lexically_normal();
}

void read_noise(const TomlValue& table, VerifySettings& verify) {
  table.expect_keys({"relative", "additive", "known"});
  verify.noise = {0.0, 0.0};
  if (const auto relative = table.find("relative")) verify.noise.relative = read_number(*relative, Range::at_least(0));
  if (const auto additive = table.find("additive")) verify.noise.additive = read_number(*additive, Range::at_least(0));
  if (const auto known = table.find("known")) verify.known_noise = known->boolean();
}

Sampling read_sampling(const TomlValue& value) {
  if (value.text() == "incidence-plane") return Sampling::incidence_plane;
  if (value.text() == "hemisphere") return Sampling::hemisphere;
  value.fail(in_quotes(value.text()) + " is not known, expected \"incidence-plane\" or \"hemisphere\"");
}

std::size_t read_trials(const TomlValue& value) {
  const std::string expected = "a whole number from 1 to " + std::to_string(most_trials);
  const std::int64_t trials = value.whole_number(expected);
  if (trials < 1 || trials > most_trials) value.fail("is " + std::to_string(trials) + ", expected " + expected);
  return static_cast<std::size_t>(trials);
}

std::pair<double, double> read_coverage(const TomlValue& array) {
  const std::string expected = "[smallest, largest]";
  std::vector<double> limits;
  array.for_each_element(expected, [&](const TomlValue& v) { limits.push_back(read_number(v, Range::closed(0, 1))); });
  if (limits.size() != 2) array.fail("has " + std::to_string(limits.size()) + " numbers, expected " + expected);
  if (limits[0] >= limits[1]) array.fail("is crossed, expected " + expected);
  return {limits[0], limits[1]};
}

void read_bounds(const TomlValue& table, VerifySettings& verify) {
  table.expect_keys({"slope_bias", "bias", "coverage_68", "coverage_95", "failure_rate"});
  if (const auto bias = table.find("slope_bias")) verify.slope_bias = read_number(*bias, Range::above(0));
  if (const auto bias = table.find("bias")) verify.bias = read_number(*bias, Range::above(0));
  if (const auto coverage = table.find("coverage_68")) verify.coverage_68 = read_coverage(*coverage);
  if (const auto coverage = table.find("coverage_95")) verify.coverage_95 = read_coverage(*coverage);
  if (const auto rate = table.find("failure_rate")) verify.failure_rate = read_number(*rate, Range::closed(0, 1));
}

}  // namespace

VerifySettings read_verify(const TomlValue& table, const std::filesystem::path& recipe) {
  table.expect_keys({"truth", "noise", "sampling", "trials", "bounds"});
  VerifySettings verify;
  verify.truth = read_truth(table, recipe);
  if (const auto noise = table.find("noise")) read_noise(*noise, verify);
  if (const auto sampling = table.find("sampling")) verify.sampling = read_sampling(*sampling);
  if (const auto trials = table.find("trials")) verify.trials = read_trials(*trials);
  if (const auto bounds = table.find("bounds")) read_bounds(*bounds, verify);
  return verify;
}

}  // namespace goniofit
