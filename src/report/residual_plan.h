#pragma once
// What a picture of residuals shows, in which unit and on which scale: decided before anything is drawn.

#include <cstddef>
#include <string>
#include <vector>

#include "../fit/fit.h"
#include "../scan/scan.h"

namespace goniofit {

struct ResidualPanel {
  double theta_i_deg = 0.0, theta_i_high_deg = 0.0;  ///< of its readings, lowest and highest
  std::vector<std::size_t> rows;                     ///< of the scan
};

/// By theta_i, readings at 90° left out. Of more than `most` incidence angles some; of few readings at each of them,
/// where no panel would say much, classes of 15°.
[[nodiscard]] std::vector<ResidualPanel> incidence_panels(const Scan& scan, std::size_t most);

/// In 1/sr: below it a quotient says more of the noise than of the fit. Thrice the noise, or a thousandth of the
/// largest value.
[[nodiscard]] double residual_floor(const Scan& scan, const FitResult& result,
                                    const std::vector<std::size_t>& channels);

struct ResidualPlan {
  std::vector<std::size_t> channels;  ///< shown: the worst alone on a map, up to three on curves
  bool map = false;                   ///< of the hemisphere; else curves against theta_r
  std::vector<ResidualPanel> panels;  ///< by theta_i
  std::size_t incidences = 0;         ///< there are
  /// (measured - fitted) / u where the scan states u; else / max(|measured|, fitted, floor).
  bool by_u = false;
  double floor = 0.0;                       ///< 1/sr
  std::vector<std::vector<double>> values;  ///< [channel shown][row of the scan]
  double limit = 1.0;                       ///< end of the scale: few residuals are beyond
  std::size_t beyond = 0;
};

/// The worst channel is the one whose loss is the largest part of its signal. Throws Error (bad_input) where material
/// and scan have other channels.
[[nodiscard]] ResidualPlan plan_residuals(const Scan& scan, const FitResult& result);

}  // namespace goniofit
