#pragma once
// Which readings a plot shows, on which axes: decided from the scan alone, before anything is drawn.

#include <cstddef>
#include <optional>
#include <vector>

#include "plot.h"

namespace goniofit {

struct PlottedIncidence {
  double theta_i_deg = 0.0;                ///< mean of its readings
  std::vector<std::size_t> rows;           ///< of the scan
  std::vector<double> signed_theta_r_deg;  ///< one a row
};

struct PlotPlan {
  std::vector<std::size_t> channels;  ///< one a panel
  std::vector<PlottedIncidence> incidences;
  double azimuth_tolerance_deg = 0.5;  ///< readings within this of the plane of incidence
  double incidence_width_deg = 0.5;    ///< readings of one curve differ by at most this in theta_i
  std::optional<double> phi_i_deg;     ///< of all readings shown; null for any, which an isotropic material lets pass
  std::size_t incidences_available = 0;
  bool log = false;
  std::size_t not_shown = 0;  ///< readings that a log axis cannot show, or that lie too far down
  double theta_min_deg = -90.0, theta_max_deg = 90.0;
  double lowest = 0.0, highest = 1.0;  ///< of the readings shown
};

/// Throws Error (bad_input) for a scan without readings near the plane of incidence.
[[nodiscard]] PlotPlan plan_plot(const Scan& scan, const PlotOptions& options);

/// The readings whose azimuth of incidence is within half a degree of `phi_i_deg`.
[[nodiscard]] std::vector<std::size_t> rows_at_azimuth(const Scan& scan, double phi_i_deg);
[[nodiscard]] Scan at_azimuth(const Scan& scan, double phi_i_deg);

/// Where to evaluate a curve: signed theta_r between the plan's ends, at most 1 degree apart, closer and closer towards
/// the mirror direction, down to a small part of `lobe_deg`.
[[nodiscard]] std::vector<double> curve_angles(const PlotPlan& plan, double theta_i_deg, double lobe_deg);

/// How wide the narrowest lobe of a material may be.
[[nodiscard]] double lobe_width_deg(const Material& material);

/// What a reader must know of the readings shown: "readings within 2° of the plane of incidence"; empty for the plain
/// case.
[[nodiscard]] std::string plot_remarks(const PlotPlan& plan);

}  // namespace goniofit
