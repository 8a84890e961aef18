#pragma once
// Order statistics of many values in linear time.

#include <cstddef>
#include <vector>

namespace goniofit {

/// The value that sorting would put at `rank`; rank < values.size(). Reorders the values.
[[nodiscard]] double value_at_rank(std::vector<double>& values, std::size_t rank);

/// How many of the largest values hold `share` < 1 of their sum; none below 0. Reorders the values.
[[nodiscard]] std::size_t count_of_largest(std::vector<double>& values, double share);

}  // namespace goniofit
