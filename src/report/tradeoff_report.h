#pragma once
// What accuracy costs in time, as tables, JSON and a picture.

#include <filesystem>
#include <string>

#include "../cost/tradeoff.h"
#include "fit_report.h"

namespace goniofit {

/// A table for each group and material, its rows by time; those of the Pareto front are marked.
[[nodiscard]] std::string tradeoff_text(const Tradeoff& tradeoff, const ReportStyle& style);

/// {"machine", "instruction_set", "reference", "seed", "rounds", "pairs", "rows": [{"name", "group", "terms",
/// "effects", "material", "model", "ns_per_evaluation", "ns_min", "ns_max", "l1_error", "rms_relative_error",
/// "max_relative_error", "pareto", ...}]}. "terms" is null for a peer.
[[nodiscard]] std::string tradeoff_json(const Tradeoff& tradeoff);

/// Error against time of whole models, both logarithmic, a panel a material, the front connected; of the first other
/// group where no models were measured. Throws Error: bad_input for an extension other than .svg and .png and where
/// there is nothing to draw, system where gnuplot is missing or fails.
void plot_tradeoff(const std::filesystem::path& path, const Tradeoff& tradeoff);

}  // namespace goniofit
