// goniofit simulate: the virtual gonioreflectometer.

#include "synthetic/simulate.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brdf/evaluator.h"
#include "cli/commands.h"
#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "cli/value_warnings.h"
#include "io/material_io.h"
#include "io/scan_reader.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::filesystem::path material, output;
  std::string sampling, noise = "0";
  std::optional<std::string> phi_i;
  std::uint64_t seed = 1;
  bool with_uncertainty = false;
};

Sampling parse_sampling(const std::string& text) {
  if (text == "incidence-plane") return Sampling::incidence_plane;
  if (text == "hemisphere") return Sampling::hemisphere;
  throw usage_error("--sampling: " + in_quotes(text) + ", expected incidence-plane or hemisphere");
}

Noise parse_noise(const std::string& text) {
  const std::vector<double> parts = parse_numbers(text, "--noise");
  if (parts.size() > 2) throw usage_error("--noise: " + in_quotes(text) + ", expected RELATIVE or RELATIVE,ADDITIVE");
  const Noise noise{.relative = parts[0], .additive = parts.size() > 1 ? parts[1] : 0.0};
  if (noise.relative < 0.0 || noise.additive < 0.0) {
    throw usage_error("--noise: " + in_quotes(text) + ", expected standard deviations of 0 or more");
  }
  return noise;
}

int run(const Options& options) {
  const Sampling sampling = parse_sampling(options.sampling);
  const Noise noise = parse_noise(options.noise);
  std::vector<double> azimuths;
  if (options.phi_i) azimuths = parse_numbers(*options.phi_i, "--phi-i");
  check_outputs({options.output}, {options.material});
  const Material material = read_material(options.material);
  const Scan scan = simulate(material, sampling, noise, options.seed, options.with_uncertainty, azimuths);
  std::vector<AnglePair> directions;
  for (std::size_t row = 0; row < scan.size(); ++row) directions.push_back(scan.angles(row));
  warn_of_values(Evaluator(material), directions, options.material.string());
  write_result(options.output, [&scan](std::ostream& out) { write_scan(out, scan); });
  return 0;
}

}  // namespace

void add_simulate(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("simulate", "Measure a material with a virtual gonioreflectometer");
  command->add_option("MATERIAL", options->material, "material JSON")->type_name("")->required();
  command->add_option("--sampling", options->sampling, "incidence-plane or hemisphere")->required()->type_name("WHICH");
  command->add_option("--noise", options->noise, "standard deviations: relative, or relative,additive (1/sr)")
      ->type_name("R[,A]")
      ->capture_default_str();
  command
      ->add_option("--phi-i", options->phi_i,
                   "azimuths of incidence in degrees (0, or 0,45,90 for an anisotropic material)")
      ->type_name("LIST");
  command->add_option("--seed", options->seed, "of the noise")->type_name("INTEGER")->capture_default_str();
  command->add_flag("--with-uncertainty", options->with_uncertainty, "add a u_ column to each channel");
  command->add_option("-o,--output", options->output, "scan CSV (standard output by default)")->type_name("FILE");
  command->footer(
      "Example:\n  goniofit simulate fits/garnet_red_paint_13.json --sampling hemisphere --noise 0.02 --seed 7 -o "
      "scan.csv");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
