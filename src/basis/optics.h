#pragma once
// The optics factors of basis.h for a channel's n, kappa or f0, at each Fresnel tier.

#include "../geometry/pair.h"
#include "../terms/fresnel.h"
#include "../terms/tiers.h"
#include "basis.h"

namespace goniofit {

/// n and kappa (exact), or their normal reflectance (schlick). T is double or a dual number when one of them is fitted.
template <class T>
struct BasicOptics {
  T n, kappa, f0;
  T t0;  ///< 1 - f0

  /// From n and kappa; f0 follows.
  [[nodiscard]] static BasicOptics of_index(const T& index, const T& absorption) {
    return {index, absorption, normal_reflectance(index, absorption), normal_transmission(index, absorption)};
  }
  /// From f0 alone (tier schlick): n and kappa are not known.
  [[nodiscard]] static BasicOptics of_reflectance(const T& reflectance) {
    return {T(1.0), T(0.0), reflectance, T(1.0 - reflectance)};
  }
};
using ChannelOptics = BasicOptics<double>;

/// Tier `none` of the Fresnel ladder is F = 1 for the surface's reflection and T = 1 for light from below it (and what
/// the surface leaves, 1 - F(u), is 1 as well: no effect is switched off by leaving the term out).
template <class T, class G>
[[nodiscard]] T fresnel(FresnelTier tier, const BasicOptics<T>& o, const BasicPair<G>& p) {
  switch (tier) {
    case FresnelTier::schlick:
      return fresnel_schlick(o.f0, p.one_minus_cos_h);
    case FresnelTier::exact:
      return fresnel_exact(o.n, o.kappa, p.cos_h, p.one_minus_cos_h);
    case FresnelTier::none:
      break;
  }
  return T(1.0);
}

/// 1 - F(u), without a difference of near equals towards grazing.
template <class T, class G>
[[nodiscard]] T remainder(FresnelTier tier, const BasicOptics<T>& o, const BasicPair<G>& p) {
  switch (tier) {
    case FresnelTier::schlick:
      return transmission_schlick(o.t0, p.cos_h);
    case FresnelTier::exact:
      return transmission_exact(o.n, o.kappa, p.cos_h, p.one_minus_cos_h);
    case FresnelTier::none:
      break;
  }
  return T(1.0);
}

/// T(cos_i) T(cos_r).
template <class T, class G>
[[nodiscard]] T transmission(FresnelTier tier, const BasicOptics<T>& o, const BasicPair<G>& p) {
  switch (tier) {
    case FresnelTier::schlick:
      return transmission_schlick(o.t0, p.cos_i) * transmission_schlick(o.t0, p.cos_r);
    case FresnelTier::exact:
      return transmission_exact(o.n, o.kappa, p.cos_i, p.one_minus_cos_i) *
             transmission_exact(o.n, o.kappa, p.cos_r, p.one_minus_cos_r);
    case FresnelTier::none:
      break;
  }
  return T(1.0);
}

template <class T, class G>
[[nodiscard]] T optics_factor(OpticsFactor factor, FresnelTier tier, const BasicOptics<T>& o, const BasicPair<G>& p) {
  switch (factor) {
    case OpticsFactor::fresnel:
      return fresnel(tier, o, p);
    case OpticsFactor::transmission:
      return transmission(tier, o, p);
    case OpticsFactor::remainder:
      return remainder(tier, o, p);
    case OpticsFactor::one:
      break;
  }
  return T(1.0);
}

}  // namespace goniofit
