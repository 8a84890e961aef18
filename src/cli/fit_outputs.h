#pragma once
// What `goniofit fit` is asked to say of a fit beside its report: profiles, and pictures of them and of the residuals.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "../fit/fit.h"
#include "../fit/settings.h"
#include "../scan/scan.h"

namespace goniofit::cli {

struct FitOutputs {
  std::string profile;
  CLI::Option* profile_flag = nullptr;
  std::vector<std::filesystem::path> profile_plots, residual_plots;
  std::filesystem::path page;  ///< empty for none

  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

void add_fit_outputs(CLI::App& command, FitOutputs& outputs);

/// Before the fit: throws Error (bad_input) naming the flag.
void check_fit_outputs(const FitOutputs& outputs);
/// What of it the fit itself has to know.
void apply_fit_outputs(const FitOutputs& outputs, FitSettings& settings);
/// `inputs` are what the fit read, each with its role.
void draw_fit_outputs(const FitOutputs& outputs, const Scan& scan, const FitResult& result,
                      const std::vector<std::pair<std::string, std::filesystem::path>>& inputs);

}  // namespace goniofit::cli
