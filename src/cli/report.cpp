// goniofit report: a material beside a scan as a page.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/outputs.h"
#include "cli/page_source.h"
#include "io/material_io.h"
#include "io/scan_reader.h"
#include "report/material_result.h"
#include "report/page.h"

namespace goniofit::cli {
namespace {

using Path = std::filesystem::path;

struct Options {
  Path material, output;
  std::vector<Path> scans;
  bool ignore_columns = false, quiet = false;
};

// The readings of all scans, in the material's channels.
Scan scan_of(const Options& options, const Material& material) {
  std::vector<Scan> scans;
  for (const Path& path : options.scans) {
    scans.push_back(read_scan(path, {.ignore_unknown_columns = options.ignore_columns}));
  }
  std::vector<std::string> names;
  for (const MaterialChannel& channel : material.channels) names.push_back(channel.name);
  return select_channels(scans.size() == 1 ? scans.front() : concatenate(scans), names);
}

int run(const Options& options) {
  std::vector<std::pair<std::string, Path>> inputs{{"material", options.material}};
  for (const Path& scan : options.scans) inputs.emplace_back("scan", scan);
  std::vector<Path> files;
  for (const auto& [role, file] : inputs) files.push_back(file);
  check_outputs({options.output}, files);
  const Material material = read_material(options.material);
  const Scan scan = scan_of(options, material);
  const std::string page = [&] {
    const ProgressLine progress("report", options.quiet);
    FitResult result = result_of_material(material, scan);
    add_reflectance(result, scan);
    PageSource source = page_source(options.output, inputs);
    source.fitted = false;
    return report_page(result, scan, source);
  }();
  write_result(options.output, page);
  return 0;
}

}  // namespace

void add_report(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("report", "Show a material beside a scan as one HTML page");
  command->add_option("MATERIAL", options->material, "material JSON")->type_name("")->required();
  command->add_option("SCAN", options->scans, "scan CSV that has the material's channels; may be repeated")
      ->type_name("")
      ->required();
  command->add_option("-o,--output", options->output, "the page ('-': standard output)")->type_name("FILE")->required();
  command->add_flag("--ignore-columns", options->ignore_columns, "skip columns that are no angle and no channel");
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer(
      "The page needs no network and no other file. Correlations, profiles and the choice of the effects are the "
      "fit's:\n"
      "goniofit fit ... --report PAGE.html has them too.\n"
      "Example:\n  goniofit report fits/garnet_red_paint_13.json data/garnet_red_paint_13.csv -o garnet.html");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
