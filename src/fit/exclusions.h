#pragma once

#include <cstddef>

namespace goniofit {

/// Readings left out, and why: whole directions, then single channels' values at directions that are used.
struct Exclusions {
  std::size_t at_90 = 0;  ///< theta of exactly 90 degrees
  std::size_t beyond_max_theta = 0;
  std::size_t retro_cone = 0;
  std::size_t saturated_values = 0;
  std::size_t clamped_values = 0;
  std::size_t negative_values = 0;  ///< kept; counted over the readings used
};

}  // namespace goniofit
