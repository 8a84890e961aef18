// goniofit tradeoff: what accuracy costs in time.

#include "cost/tradeoff.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brdf/paper_samples.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "io/material_io.h"
#include "report/gnuplot.h"
#include "report/tradeoff_report.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::vector<std::filesystem::path> materials, plots;
  std::optional<std::filesystem::path> output;
  std::optional<std::string> groups, peers, instructions;
  std::optional<std::size_t> rounds;
  std::uint64_t seed = 1;
  bool json = false, quick = false, quiet = false;
};

std::vector<TradeoffGroup> parse_groups(const std::string& text) {
  std::vector<TradeoffGroup> groups;
  for (const std::string& word : parse_words(text, "--groups")) {
    const std::optional<TradeoffGroup> group = parse_name<TradeoffGroup>(word);
    if (!group) {
      throw usage_error("--groups: no group " + in_quotes(word) + ", expected " + names_of<TradeoffGroup>());
    }
    groups.push_back(*group);
  }
  return groups;
}

InstructionSet parse_instructions(const std::string& text) {
  for (const InstructionSet set : all_instruction_sets) {
    if (text != name_of(set)) continue;
    if (set > best_instruction_set()) throw usage_error("--instructions: this processor has no " + text);
    return set;
  }
  throw usage_error("--instructions: " + in_quotes(text) + ", expected SSE2, AVX2 or AVX-512");
}

TradeoffSettings settings_of(const Options& options) {
  TradeoffSettings s = options.quick ? TradeoffSettings::quick() : TradeoffSettings{};
  if (options.groups) s.groups = parse_groups(*options.groups);
  if (options.peers) s.peers = parse_words(*options.peers, "--peers");
  if (options.instructions) s.instructions = parse_instructions(*options.instructions);
  if (options.rounds) {
    if (*options.rounds == 0) throw usage_error("--rounds: expected 1 or more");
    s.timing.rounds = *options.rounds;
  }
  s.seed = s.timing.seed = s.errors.seed = options.seed;
  return s;
}

std::vector<Material> read_materials(const Options& options) {
  std::vector<Material> materials;
  for (const std::filesystem::path& path : options.materials) materials.push_back(read_material(path));
  if (materials.empty()) {
    for (Material& m : paper_samples()) materials.push_back(std::move(m));
  }
  return materials;
}

int run(const Options& options) {
  const TradeoffSettings settings = settings_of(options);
  for (const std::filesystem::path& plot : options.plots) (void)is_png(plot);
  std::vector<std::filesystem::path> outputs = options.plots;
  if (options.output) outputs.push_back(*options.output);
  check_outputs(outputs, options.materials);
  const std::vector<Material> materials = read_materials(options);
  const Tradeoff tradeoff = [&] {
    ProgressLine line("tradeoff", options.quiet);
    return measure_tradeoff(materials, settings, [&line](const std::string& what, std::size_t done, std::size_t total) {
      line.show(what, done, total);
    });
  }();
  for (const std::filesystem::path& plot : options.plots) plot_tradeoff(plot, tradeoff);
  if (options.output) write_result(*options.output, tradeoff_json(tradeoff));
  const bool json_is_out = options.output && is_stdout(*options.output);
  if (!json_is_out) to_stdout(options.json ? tradeoff_json(tradeoff) : tradeoff_text(tradeoff, stdout_style()));
  return 0;
}

}  // namespace

void add_tradeoff(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("tradeoff", "Measure what accuracy costs in time");
  command->add_option("MATERIAL", options->materials, "material JSON (the paper's four samples by default)")
      ->type_name("");
  command->add_option("--groups", options->groups, "of " + names_of<TradeoffGroup>() + " (all by default)")
      ->type_name("LIST");
  command->add_option("--peers", options->peers, "models to fit beside the surface's (all of `goniofit models`)")
      ->type_name("LIST");
  command->add_option("--plot", options->plots, "error against time, .svg or .png; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("-o,--output", options->output, "write the JSON here")->type_name("FILE");
  command->add_option("--rounds", options->rounds, "each candidate is timed once a round (21)")->type_name("N");
  command->add_option("--instructions", options->instructions, "SSE2, AVX2 or AVX-512 (the widest there is)")
      ->type_name("WHICH");
  command->add_option("--seed", options->seed, "of the directions")->type_name("INTEGER")->capture_default_str();
  command->add_flag("--quick", options->quick, "few rounds and directions: for trying out");
  command->add_flag("--json", options->json, "the tables as JSON");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "Times are of one thread, from unit vectors on, and differ from run to run; errors do not.\n"
      "Example:\n  goniofit tradeoff --groups model,effects --plot front.svg -o tradeoff.json");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
