#pragma once
// A fit as one HTML page that needs nothing else: no network, no other file.

#include <string>
#include <utility>
#include <vector>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

/// Where a page comes from: what its last section says.
struct PageSource {
  struct Input {
    std::string role;  ///< "scan", "material", "recipe"
    std::string file, sha256;
  };
  std::vector<Input> inputs{};
  std::string command{};                                        ///< as it was typed
  std::vector<std::pair<std::string, std::string>> versions{};  ///< of the program and the libraries, by name
  /// Whether `result` is that of the fit itself, with all that it knows; else made of a material and a scan.
  bool fitted = true;
};

/// What `report` and `fit --report` put into `source.inputs`. Throws Error (system) where the file cannot be read.
[[nodiscard]] PageSource::Input page_input(const std::string& role, const std::string& file);

/// goniofit's, Ceres' and Eigen's versions.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> library_versions();

/// The page. Every text from files is escaped; the page's policy (CSP) forbids requests and all scripts but its own.
/// No date: the same arguments give the same bytes. Throws Error (bad_input) where material and scan have other
/// channels.
[[nodiscard]] std::string report_page(const FitResult& result, const Scan& scan, const PageSource& source);

/// The JSON that the page draws, which it holds in its element "report-data":
/// {"format": "goniofit-report", "version": 1, "title", "fitted", "subject": [[label, text] ...], "verdict": {"name",
/// "words", "finding"}, "fit": as `fit --json` but for the time that it took, "texts": of each of the fit's parameters
/// {"value", "u", "relative", "interval", "unit", "remark"} rounded to what u supports, "sentences", "sphere": {"png",
/// "caption", "alt"}, "plots": see page_plots.h, "material": as the material's own file, "source"}.
[[nodiscard]] std::string page_data(const FitResult& result, const Scan& scan, const PageSource& source);

}  // namespace goniofit
