// goniofit inspect: what is in a scan.

#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/console.h"
#include "io/scan_reader.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::filesystem::path scan;
  bool json = false;
  bool ignore_columns = false;
};

int run(const Options& options) {
  const Scan scan = read_scan(options.scan, {.ignore_unknown_columns = options.ignore_columns});
  to_stdout(options.json ? scan_summary_json(scan) : scan_summary(scan, stdout_style()));
  return 0;
}

}  // namespace

void add_inspect(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("inspect", "Read and validate a scan, and summarise it");
  command->add_option("SCAN", options->scan, "scan CSV")->type_name("")->required();
  command->add_flag("--json", options->json, "the summary as JSON");
  command->add_flag("--ignore-columns", options->ignore_columns, "skip columns that are no angle and no channel");
  command->footer("Example:\n  goniofit inspect data/garnet_red_paint_13.csv");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
