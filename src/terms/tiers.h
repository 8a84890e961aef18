#pragma once
// The ladders: each of the four terms of the one reflectance formula has exchangeable tiers, from exact to cheap.

#include <cstdint>

namespace goniofit {

enum class FresnelTier : std::uint8_t { schlick, exact, none };
enum class ShadowingTier : std::uint8_t { li_torrance, smith, schlick, none };
enum class EffectiveRoughnessTier : std::uint8_t { li_torrance, he, none };
enum class DistributionTier : std::uint8_t {
  rough_limit,         ///< the limit of he_torrance for rough surfaces, and Beckmann's
  he_torrance,         ///< wave optics; knows sigma and tau apart
  he_torrance_series,  ///< the same by the plain sum: slow, the yardstick
  student_t            ///< long-tailed slopes, with the tail as a parameter
};

}  // namespace goniofit
