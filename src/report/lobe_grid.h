#pragma once
// Directions at which the surface of a lobe is computed.

#include <vector>

namespace goniofit {

/// Every theta with every phi. Degrees; phi is that of the reflected direction less that of the light: 180 is forward.
struct LobeGrid {
  std::vector<double> theta_deg, phi_deg;
};

/// Over the hemisphere, closer and closer towards the mirror direction, down to a small part of `width_deg`, which is
/// that of the lobe. phi ends at 180, where the left half is the right one's mirror image, unless `whole`.
[[nodiscard]] LobeGrid lobe_grid(double theta_i_deg, double width_deg, bool whole);

}  // namespace goniofit
