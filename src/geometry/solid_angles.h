#pragma once
// What solid angle each direction of an uneven sampling stands for.

#include <vector>

#include "direction.h"

namespace goniofit {

/// The part of the hemisphere that lies nearer to each direction than to any other, in steradians; their sum is 2 pi.
/// Directions that coincide share a cell evenly. O(n log n) where neighbours are alike in number.
[[nodiscard]] std::vector<double> solid_angles(const std::vector<Direction>& directions);

/// The same along an arc: half of the way to both neighbours, in the unit of the angles; at the ends the outer half is
/// as wide as the inner one. Angles that coincide share theirs. One angle alone stands for 1.
[[nodiscard]] std::vector<double> arc_lengths(const std::vector<double>& angles);

}  // namespace goniofit
