#pragma once
// The two samplings of Li & Torrance 2005, and the concentric square (Shirley & Chiu 1997) they and the tables stand
// on.

#include <cstddef>
#include <vector>

#include "pair.h"

namespace goniofit {

struct SquarePoint {
  double u, v;  ///< in [0, 1]²
};
struct HemispherePoint {
  double theta_deg, phi_deg;
};

/// Concentric square to hemisphere with equal areas mapped to equal solid angles (z = 1 - r²), and back.
[[nodiscard]] HemispherePoint square_to_hemisphere(SquarePoint p) noexcept;
[[nodiscard]] SquarePoint hemisphere_to_square(HemispherePoint p) noexcept;

/// Centres of the n × n cells of the concentric square, row by row: 21 gives the paper's 441 directions.
[[nodiscard]] std::vector<HemispherePoint> square_cell_centres(std::size_t n);

/// theta_i 15, 30, 45, 60, 75; 40 to 70 signed theta_r each in ±85°, denser near the mirror direction, which is always
/// one of them.
[[nodiscard]] std::vector<AnglePair> incidence_plane_sampling();

/// theta_i 10 ... 80 by 10, phi_i = 0, the 441 cell centres each; `with_mirror` adds the mirror direction of each.
[[nodiscard]] std::vector<AnglePair> hemisphere_sampling(bool with_mirror);

}  // namespace goniofit
