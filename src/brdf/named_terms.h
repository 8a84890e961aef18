#pragma once
// The sets of tiers that have a name of their own.

#include <optional>
#include <string_view>

#include "material.h"

namespace goniofit {

/// "li-torrance": the terms as published in 2005, which are the defaults. "he-torrance": those of He et al. 1991, which
/// the former approximate. nullopt for any other name.
[[nodiscard]] inline std::optional<Terms> named_terms(std::string_view name) noexcept {
  if (name == "li-torrance") return Terms{};
  if (name == "he-torrance") {
    return Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he, DistributionTier::he_torrance};
  }
  return std::nullopt;
}

}  // namespace goniofit
