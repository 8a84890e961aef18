#pragma once
// The azimuth difference Δφ = φ_r - φ_i of a pair, in the form that Oren & Nayar 1994 read: both directions point away
// from the surface, so Δφ = 0 is the retro side.

#include "../geometry/pair.h"
#include "scalar.h"
#include "zenith.h"

namespace goniofit {

template <class G>
struct AzimuthDifference {
  G sin_i, sin_r;                ///< of the zenith angles
  G cos;                         ///< cos Δφ; 1 at the normal, where Δφ means nothing
  G one_minus_abs_cos;           ///< 1 - |cos Δφ| >= 0, see below
  [[nodiscard]] G sin() const {  ///< |sin Δφ|
    using namespace math;
    return sqrt(one_minus_abs_cos * (2.0 - one_minus_abs_cos));
  }
};

/// 1 - |cos Δφ| is made of |L+V|² or |L-V|²: towards double grazing it is multiplied by a tangent that grows without
/// bound, where 1 - |dot_h|/(sin sin) would have lost its digits. Absolute error 1e-16 cos_i cos_r there. Nearer to the
/// normal it is 1e-16 sin(max)/sin(min), where whatever reads Δφ has a factor sin(min).
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline AzimuthDifference<G> azimuth_difference(const BasicPair<G>& p) {
  using namespace math;
  AzimuthDifference<G> d;
  d.sin_i = sine(p.cos_i, p.one_minus_cos_i);
  d.sin_r = sine(p.cos_r, p.one_minus_cos_r);
  const G product = d.sin_i * d.sin_r;
  const bool defined = product > 0.0;
  const G safe = select(defined, product, G(1.0));
  d.cos = select(defined, G(p.dot_h / safe), G(1.0));
  const G height = p.cos_i - p.cos_r;
  const G safe_sum = select(defined, G(d.sin_i + d.sin_r), G(1.0));
  const G radius = height * p.s_z / safe_sum;  // sin_r - sin_i without a cancellation
  const G retro2 = 4.0 * (1.0 + p.cos_h) * p.one_minus_cos_h - height * height;
  const G twice = select(p.dot_h < 0.0, p.s_h2, retro2) - radius * radius;
  const G distance = select(defined, G(twice / (2.0 * safe)), G(0.0));
  d.one_minus_abs_cos = select(distance < 0.0, G(0.0), select(distance > 1.0, G(1.0), distance));
  return d;
}

}  // namespace goniofit
