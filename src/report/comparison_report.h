#pragma once
// What `compare` says: a row a model, the best first.

#include <filesystem>
#include <string>
#include <vector>

#include "../fit/comparison.h"
#include "fit_report.h"

namespace goniofit {

/// What is wrong or weak about a row: "did not converge", "slope at upper bound". Empty for a sound one.
[[nodiscard]] std::vector<std::string> remarks_of(const ComparedFit& row);

[[nodiscard]] std::string comparison_report(const Comparison& comparison, const Scan& scan, const ReportStyle& style);
/// The same as JSON, each row with its material's parameters.
[[nodiscard]] std::string comparison_json(const Comparison& comparison, const Scan& scan);

/// A bar a model, as long as the root mean square of its weighted residuals (logarithmic where they span more than a
/// factor 10). SVG or PNG by the extension. Throws Error: bad_input for another extension, system where gnuplot fails.
void plot_comparison(const std::filesystem::path& path, const Comparison& comparison, const Scan& scan);

}  // namespace goniofit
