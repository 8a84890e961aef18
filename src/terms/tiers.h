#pragma once
// The ladders: each of the four terms of the one reflectance formula has exchangeable tiers, from exact to cheap.

#include <cstdint>

namespace goniofit {

enum class FresnelTier : std::uint8_t { schlick, exact, none };
enum class ShadowingTier : std::uint8_t { li_torrance, none };
enum class EffectiveRoughnessTier : std::uint8_t { li_torrance, none };
enum class DistributionTier : std::uint8_t { rough_limit };

}  // namespace goniofit
