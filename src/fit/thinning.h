#pragma once
// Which readings of a very large scan the global search looks at, and the noise of its residuals is told from. The loss
// over the shape has the same dips seen through some ten thousand well chosen readings as through a million; the polish
// reads all of them and decides.
//
// All readings that hold more than their part of the squared signal stay, since they rule the loss. The others are
// drawn by strata: of their distance from the mirror direction, in steps of a lobe's width, and of their grazing angle;
// evenly along the scan within each, with weights so that sums over the readings drawn estimate those over all.

#include <cstddef>

#include "problem.h"

namespace goniofit {

/// All for scans of up to that many readings, and under losses that are not quadratic in the model.
inline constexpr std::size_t most_searched = most_held;
/// Deterministic. Reflectances stay.
[[nodiscard]] RowSelection searched_rows(const Problem& problem);

}  // namespace goniofit
