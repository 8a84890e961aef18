#pragma once
// What a run of `verify` says: for the terminal, for programs, for a page, and as a picture. Limits of coverages and
// failure rates are Clopper & Pearson's; those of a failure rate one-sided.

#include <filesystem>
#include <span>
#include <string>

#include "../synthetic/verify.h"
#include "fit_report.h"

namespace goniofit {

/// Reports judged together, and the level they were judged at.
struct VerifyRunReport {
  std::span<const VerifyReport> recipes;
  const RandomRecoveryReport* random = nullptr;
  double level = default_level;

  /// Statements tested: what Holm's correction corrected for.
  [[nodiscard]] std::size_t tests() const noexcept;
  [[nodiscard]] std::size_t missed() const noexcept;
  /// No bound missed and no wrong minimum.
  [[nodiscard]] bool passed() const noexcept;
};

/// A table a recipe: a row a parameter.
[[nodiscard]] std::string verify_text(const VerifyRunReport& run, const ReportStyle& style);
/// {"level", "tests", "recipes": [...], "random": {...} or null, "passed"}: everything.
[[nodiscard]] std::string verify_json(const VerifyRunReport& run);
/// A table with a row a recipe, and one of what missed, its channels together.
[[nodiscard]] std::string verify_markdown(const VerifyRunReport& run);

/// Coverage of each parameter with its limits against its bounds, grouped by recipe; one panel for 68 and one for 95 %.
/// The channels of a parameter are dots of one row, the first on top. SVG or PNG by the extension. Throws Error:
/// bad_input for another extension or where no recipe states an interval, system where gnuplot fails.
void plot_verify(const std::filesystem::path& path, const VerifyRunReport& run);

}  // namespace goniofit
