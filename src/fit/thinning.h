#pragma once
// Which readings of a very large scan the global search looks at. The loss over the shape has the same dips seen
// through some ten thousand well chosen readings as through a million; the polish reads all of them and decides.
//
// All readings that hold more than their part of the squared signal stay, since they rule the loss. The others are
// drawn by strata: of their distance from the mirror direction, in steps of a lobe's width, and of their grazing angle;
// evenly along the scan within each, with weights so that sums over the readings drawn estimate those over all.

#include <cstddef>
#include <vector>

#include "problem.h"

namespace goniofit {

struct RowSelection {
  std::vector<std::size_t> rows{};  ///< ascending
  std::vector<double> factor{};     ///< of each one's residual: the square root of the readings that it stands for

  [[nodiscard]] bool all() const noexcept { return rows.empty(); }
};

/// All for scans of up to that many readings, and under losses that are not quadratic in the model.
inline constexpr std::size_t most_searched = 100000;
/// Deterministic. Reflectances stay.
[[nodiscard]] RowSelection searched_rows(const Problem& problem);

}  // namespace goniofit
