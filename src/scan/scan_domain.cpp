#include "scan/scan_domain.h"

#include <algorithm>

#include "support/error.h"

namespace goniofit {

Domain domain_of(const Scan& scan) {
  Domain d{.theta_i_min_deg = 90.0, .theta_i_max_deg = 0.0, .theta_r_max_deg = 0.0};
  for (std::size_t row = 0; row < scan.size(); ++row) {
    if (scan.theta_i_deg[row] >= 90.0) continue;
    d.theta_i_min_deg = std::min(d.theta_i_min_deg, scan.theta_i_deg[row]);
    d.theta_i_max_deg = std::max(d.theta_i_max_deg, scan.theta_i_deg[row]);
    d.theta_r_max_deg = std::max(d.theta_r_max_deg, scan.theta_r_deg[row]);
  }
  if (!(d.theta_r_max_deg > 0.0)) throw usage_error(scan.source + ": has no readings below 90 degrees");
  const bool all_known = std::all_of(scan.channels.begin(), scan.channels.end(),
                                     [](const ScanChannel& c) { return c.wavelength_um.has_value(); });
  if (all_known) {
    for (const ScanChannel& c : scan.channels) d.wavelengths_um.push_back(*c.wavelength_um);
  }
  d.solid_angle_sr = scan.solid_angle_sr;
  return d;
}

}  // namespace goniofit
