#include "geometry/domain.h"

#include <cmath>

#include "geometry/angles.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

void validate(const Domain& d) {
  if (!(d.theta_i_min_deg >= 0.0 && d.theta_i_min_deg <= d.theta_i_max_deg && d.theta_i_max_deg < 90.0)) {
    throw usage_error("incidence from " + shortest(d.theta_i_min_deg) + " to " + shortest(d.theta_i_max_deg) +
                      " degrees: expected two angles in [0, 90), the smaller first");
  }
  if (!(d.theta_r_max_deg > 0.0 && d.theta_r_max_deg <= 90.0)) {
    throw usage_error("directions up to " + shortest(d.theta_r_max_deg) + " degrees: expected an angle in (0, 90]");
  }
  for (const double wavelength : d.wavelengths_um) {
    if (!(wavelength > 0.0 && std::isfinite(wavelength))) {
      throw usage_error("wavelength " + shortest(wavelength) + " um: expected a number above 0");
    }
  }
  if (d.solid_angle_sr && !(*d.solid_angle_sr > 0.0 && *d.solid_angle_sr < 2.0 * pi)) {
    throw usage_error("solid angle " + shortest(*d.solid_angle_sr) + " sr: expected a number above 0 and below 2 pi");
  }
}

}  // namespace goniofit
