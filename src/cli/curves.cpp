// goniofit curves: the tiers of one term as a table, for plots.

#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/outputs.h"
#include "report/term_curves.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::string term;
  TermCurveSettings settings{};
  std::filesystem::path output{};
};

std::string csv(const TermCurves& curves) {
  std::string text;
  const auto end_row = [&] { text.back() = '\n'; };
  for (const std::string& column : curves.columns) text += column + ',';
  end_row();
  for (const auto& row : curves.rows) {
    for (const double value : row) text += shortest(value) + ',';
    end_row();
  }
  return text;
}

}  // namespace

void add_curves(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  TermCurveSettings& s = options->settings;
  CLI::App* command = program.add_subcommand("curves", "The tiers of one term against an angle, as CSV for plots");
  command->add_option("TERM", options->term, std::string(term_curve_names))->type_name("")->required();
  command->add_option("--slope", s.slope, "sigma/tau")->type_name("M")->capture_default_str();
  command->add_option("--n", s.n, "refractive index, of fresnel")->type_name("N")->capture_default_str();
  command->add_option("--kappa", s.kappa, "absorption index, of fresnel")->type_name("K")->capture_default_str();
  command->add_option("--isotropy", s.p, "Schlick's p, of azimuth")->type_name("P")->capture_default_str();
  command->add_option("--steps", s.steps, "intervals of the angle")->type_name("INTEGER")->capture_default_str();
  command->add_option("-o,--output", options->output, "write here (standard output)")->type_name("FILE");
  command->footer("Example:\n  goniofit curves shadowing --slope 0.17 -o shadowing.csv");
  command->callback([options, &status] {
    check_outputs({options->output}, {});
    write_result(options->output, csv(term_curves(options->term, options->settings)));
    status = 0;
  });
}

}  // namespace goniofit::cli
