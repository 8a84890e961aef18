// goniofit export: a material in other formats.

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/outputs.h"
#include "io/exr_table.h"
#include "io/material_io.h"
#include "report/number_text.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::vector<std::filesystem::path> materials;
  std::filesystem::path output;
  std::string format;
  ExrTableOptions exr;
  bool quiet = false;
};

void export_exr(const Options& options, const Material& material) {
  const BrdfTable table = [&] {
    const ProgressLine progress("tabulating", options.quiet);
    return tabulate(material, options.exr);
  }();
  write_exr(options.output, material, table);
  to_stdout("interpolation error of the table: RMS " + percent_text(table.interpolation_rms) + ", largest " +
            percent_text(table.interpolation_max) + " of the highest value at its incidence\n");
}

void check_usage(const Options& options) {
  if (options.format != "csv" && options.format != "json" && options.format != "exr") {
    throw usage_error("--format: " + in_quotes(options.format) + ", expected csv, json or exr");
  }
  if (options.format != "csv" && options.materials.size() > 1) {
    throw usage_error("--format " + options.format + " holds one material; csv is the format for several");
  }
  if (options.format == "exr" && is_stdout(options.output)) throw usage_error("--format exr: needs a file (-o FILE)");
  constexpr std::size_t largest_size = 4096;
  if (options.exr.size < 2 || options.exr.size > largest_size)
    throw usage_error("--size: expected 2 to 4096 cells a side");
  if (!(options.exr.incidence_step_deg >= 0.1 && options.exr.incidence_step_deg <= 85.0)) {
    throw usage_error("--incidence-step: expected 0.1 to 85 degrees");
  }
  check_outputs({options.output}, options.materials);
}

int run(const Options& options) {
  check_usage(options);
  std::vector<Material> materials;
  materials.reserve(options.materials.size());
  for (const std::filesystem::path& path : options.materials) materials.push_back(read_material(path));
  if (options.format == "exr") {
    export_exr(options, materials.front());
  } else {
    write_result(options.output, options.format == "csv" ? to_csv(materials) : to_json(materials.front()));
  }
  return 0;
}

}  // namespace

void add_export(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("export", "Write materials in another format");
  command->add_option("MATERIAL", options->materials, "material JSON; several with --format csv")
      ->type_name("")
      ->required();
  command->add_option("--format", options->format, "csv, json or exr")->required()->type_name("FORMAT");
  command->add_option("-o,--output", options->output, "standard output by default, except for exr")->type_name("FILE");
  command->add_option("--size", options->exr.size, "exr: cells along each side of the square")
      ->type_name("CELLS")
      ->capture_default_str();
  command->add_option("--incidence-step", options->exr.incidence_step_deg, "exr: degrees between incidence angles")
      ->type_name("DEG")
      ->capture_default_str();
  command->add_flag("-q,--quiet", options->quiet, "no progress on standard error");
  command->footer("Example:\n  goniofit export fits/garnet_red_paint_13.json --format exr -o garnet.exr");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
