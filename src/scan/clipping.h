#pragma once
// Values that repeat where measured ones do not: a detector that saturated, or noise that was cut off at zero.

#include <cstddef>
#include <span>

namespace goniofit {

struct Clipping {
  bool all_zero = false;
  std::size_t at_zero = 0;     ///< values of exactly 0, where they are too many for chance
  std::size_t at_maximum = 0;  ///< values of exactly the largest, where they are too many (and no more than half)
  double maximum = 0.0;
};

/// Too many is more than four, and more than one in a hundred.
[[nodiscard]] Clipping clipping_of(std::span<const double> values) noexcept;

}  // namespace goniofit
