#include "cli/fit_outputs.h"

#include <system_error>

#include "cli/number_arguments.h"
#include "cli/outputs.h"
#include "cli/page_source.h"
#include "report/gnuplot.h"
#include "report/page.h"
#include "report/profile_plot.h"
#include "report/residual_plot.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {

namespace {

void check_pictures(const std::vector<std::filesystem::path>& paths, const std::string& flag) {
  for (const std::filesystem::path& path : paths) {
    if (is_stdout(path)) throw usage_error(flag + ": a picture needs a file name ending in .svg or .png");
    static_cast<void>(is_png(path));
  }
}

}  // namespace

std::vector<std::filesystem::path> FitOutputs::files() const {
  std::vector<std::filesystem::path> all = profile_plots;
  all.insert(all.end(), residual_plots.begin(), residual_plots.end());
  if (!page.empty()) all.push_back(page);
  return all;
}

void add_fit_outputs(CLI::App& command, FitOutputs& outputs) {
  command.add_option("--report", outputs.page, "the fit as one HTML page, which needs no network")->type_name("FILE");
  outputs.profile_flag =
      command
          .add_option("--profile", outputs.profile,
                      "intervals by profile likelihood, of all parameters or of those named (slope,R.k_fs)")
          ->type_name("[LIST]")
          ->expected(0, 1)
          ->group("Uncertainty");
  command
      .add_option("--profile-plot", outputs.profile_plots,
                  "the profiles, .svg or .png; may be repeated; profiles all parameters where --profile names none")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Uncertainty");
  command
      .add_option("--residual-plot", outputs.residual_plots,
                  "residuals against direction, .svg or .png: maps of the hemisphere or curves; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void check_fit_outputs(const FitOutputs& outputs) {
  if (!outputs.page.empty() && is_stdout(outputs.page)) throw usage_error("--report: a page needs a file name");
  check_pictures(outputs.profile_plots, "--profile-plot");
  check_pictures(outputs.residual_plots, "--residual-plot");
  std::error_code ignored;
  if (!outputs.profile.empty() && std::filesystem::is_regular_file(outputs.profile, ignored)) {
    throw usage_error("--profile: " + in_quotes(outputs.profile) +
                      " is a file, expected names of parameters; put scans before the flag");
  }
}

void apply_fit_outputs(const FitOutputs& outputs, FitSettings& settings) {
  if (outputs.profile_flag->count() == 0 && outputs.profile_plots.empty()) return;
  settings.profile.emplace();
  if (!outputs.profile.empty()) settings.profile = parse_words(outputs.profile, "--profile");
}

void draw_fit_outputs(const FitOutputs& outputs, const Scan& scan, const FitResult& result,
                      const std::vector<std::pair<std::string, std::filesystem::path>>& inputs) {
  for (const std::filesystem::path& path : outputs.profile_plots) plot_profiles(path, result, scan);
  for (const std::filesystem::path& path : outputs.residual_plots) plot_residuals(path, scan, result);
  if (!outputs.page.empty()) {
    write_result(outputs.page, report_page(result, scan, page_source(outputs.page, inputs)));
  }
}

}  // namespace goniofit::cli
