#pragma once
// What a material's cheaper variants are measured against: the same coefficients with the most exact terms that it
// knows the parameters of.

#include <string>

#include "../brdf/material.h"

namespace goniofit {

struct Reference {
  Material material;
  std::string name;  ///< "he-torrance-series, exact terms"
};

enum class WaveOptics { series, fast };  ///< the plain sum, or the expansion that is good to 1e-9

/// Fresnel exact (schlick where only f0 is known), shadowing smith (as given where the tail is too long for it),
/// effective roughness he, and He et al.'s distribution, or the rough limit where sigma or a wavelength is not known;
/// long-tailed slopes keep their distribution. Forms and coefficients are the material's own: its coefficients mean
/// what they were fitted with. Throws Error (bad_input) for an invalid material and for a peer, which has no terms.
[[nodiscard]] Reference reference_of(const Material& material, WaveOptics wave_optics);

/// The terms as published, or as near to them as the material can: long-tailed slopes keep their distribution.
[[nodiscard]] Terms published_terms(const Material& material);

/// The effects that are among the components and have a coefficient other than 0 in some channel.
[[nodiscard]] EffectSet acting_effects(const Material& material);

}  // namespace goniofit
