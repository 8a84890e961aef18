#pragma once
// What a fit prints in the terminal.

#include <string>
#include <vector>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

struct ReportStyle {
  bool color = false;  ///< ANSI colours (a terminal, and NO_COLOR unset)
  bool show_reflectance = true;
};

[[nodiscard]] std::string fit_report(const FitResult& result, const Scan& scan, const ReportStyle& style);
/// The same content as JSON, for --json.
[[nodiscard]] std::string fit_report_json(const FitResult& result, const Scan& scan);

/// What `inspect` says of a scan.
[[nodiscard]] std::string scan_summary(const Scan& scan, const ReportStyle& style);
[[nodiscard]] std::string scan_summary_json(const Scan& scan);

}  // namespace goniofit
