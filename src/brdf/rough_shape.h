#pragma once
// The shape factors of the rough effect, f = rho/pi direct + rho²/pi interreflection, by the form chosen. facet_slope
// in radians.

#include "../geometry/pair.h"
#include "../terms/oren_nayar.h"
#include "../terms/v_cavity_integral.h"
#include "material.h"

namespace goniofit {

template <class T>
struct RoughFactors {
  T direct{}, interreflection{};
};

/// The integral's relative tolerance: a thousandth of what the best goniometers state.
inline constexpr double v_cavity_tolerance = 1e-6;

[[nodiscard]] inline bool functional_is_cut(double facet_slope, const Pair& p) noexcept {
  return oren_nayar::needs_cut(oren_nayar::functional(facet_slope, p).direct);
}

/// Of the two closed forms, uncut: the functional one's direct part turns negative at forward grazing from a facet
/// slope of some 40°. A fit takes it as it is, since a cut would put a crease into its loss. The qualitative form has
/// no interreflection.
template <class T, class G>
[[nodiscard]] RoughFactors<T> closed_rough_factors(RoughForm form, const T& facet_slope, const BasicPair<G>& p) {
  if (form == RoughForm::qualitative) return {oren_nayar::qualitative(facet_slope, p), T(0.0)};
  const oren_nayar::Functional<T> f = oren_nayar::functional(facet_slope, p);
  return {f.direct, f.interreflection};
}

/// What evaluation takes: cut at zero, see oren_nayar::cut_at_zero.
[[nodiscard]] inline RoughFactors<double> rough_factors(RoughForm form, double facet_slope, const Pair& p) {
  if (form != RoughForm::integral) {
    const RoughFactors<double> f = closed_rough_factors(form, facet_slope, p);
    return {oren_nayar::cut_at_zero(f.direct), f.interreflection};
  }
  const VCavities v = gaussian_cavities(p, facet_slope, v_cavity_tolerance);
  return {v.direct, v.interreflection};
}

}  // namespace goniofit
