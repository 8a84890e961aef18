#pragma once
// Which expression gives ln W(g, x) of He et al. 1991 where, for blocks of values (he_torrance_block.h). With r = 1/g,
// y = x/g, xi = x/g² and w = W0(2 xi)/2 the summand peaks at J = g e^w.
//
// Where the sum is a smooth function of its saddle point (he_torrance_saddle.h), that is where J is large and the
// summands of small j, of order e^-g-x, have died away,
//   ln W = -ln g - y G(xi) + P(r q(xi), xi),  q roughly e^-w, so that r q is roughly 1/J,
// with G and P as polynomials. Where they have not, but g is above 15, ln W = -ln g - y + P(r, x). Where J is small,
// the sum of the first few terms. The rest, W of rough surfaces below e^-100 and W of extremely smooth ones in their
// tails, is left to he_torrance.h.
//
// Everything here is free of branches, for vectorised loops: a region is a number.

#include <cstdint>
#include <type_traits>

namespace goniofit::he_torrance {

/// The fine expressions are within 1e-9, the coarse within 1e-4. A region is a polynomial's or `rest`; the rest has its
/// own.
namespace fine {
enum Region : int { shallow_large, shallow, deep, shallow_small, deep_small, origin, rest };
enum Rest : int { sum_16, sum_32, sum_48, scalar };
}  // namespace fine
namespace coarse {
enum Region : int { saddle, origin, rest };
enum Rest : int { sum_8, sum_16, sum_32, scalar };
}  // namespace coarse

/// Largest xi of polynomials: w = 4.5.
inline constexpr double greatest_xi = 36463.0;
/// Between the shallow and the deep ones: w = 0.75.
inline constexpr double deep_xi = 3.361;

/// As wide as Real: lanes of one width vectorise best.
template <class Real>
using RegionNumber = std::conditional_t<std::is_same_v<Real, float>, std::int32_t, std::int64_t>;

/// Compares the peak J with bounds, within 4 % below w = 2 (less than J beyond: by a quarter at w = 4.5), by
/// J ~ g (1 + 2 xi)^(3/8): no transcendental function.
template <class Real>
struct PeakBound {
  Real shape, r8;

  [[gnu::always_inline]] PeakBound(Real r, Real xi) {
    const Real t = Real(1) + Real(2) * xi;
    const Real r2 = r * r;
    const Real r4 = r2 * r2;
    shape = t * t * t;
    r8 = r4 * r4;
  }
  [[nodiscard]] [[gnu::always_inline]] bool above(double j) const { return shape >= eighth(j) * r8; }
  /// Below one of two bounds: at small xi, at large.
  [[nodiscard]] [[gnu::always_inline]] bool below(bool deep, double j, double j_deep) const {
    return shape < (deep ? eighth(j_deep) : eighth(j)) * r8;
  }

 private:
  [[nodiscard]] [[gnu::always_inline]] static Real eighth(double j) {
    const double j4 = j * j * j * j;
    return Real(j4 * j4);
  }
};

/// A polynomial's region, or fine::rest. Selects only: conditions joined by `and` take the vectoriser half as long
/// again.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline RegionNumber<Real> fine_region(Real r, Real x) {
  using namespace fine;
  using Number = RegionNumber<Real>;
  constexpr Real large_g(1.0 / 70.0);
  const Real xi = x * r * r;
  const PeakBound<Real> peak(r, xi);
  Number flat = peak.above(12.0) ? Number(shallow_small) : Number(rest);
  flat = peak.above(20.0) ? Number(shallow) : flat;
  flat = peak.above(50.0) ? Number(shallow_large) : flat;
  flat = r <= large_g ? Number(shallow_large) : flat;
  Number steep = xi <= Real(179.2) ? Number(deep_small) : Number(rest);
  steep = peak.above(12.0) ? steep : Number(rest);
  steep = peak.above(20.0) ? Number(deep) : steep;
  steep = xi <= Real(greatest_xi) ? steep : Number(rest);
  const Number saddle = xi > Real(deep_xi) ? steep : flat;
  const Number near = r <= Real(1.0 / 15.0) ? Number(origin) : Number(rest);
  const Number unclear = x >= Real(25) ? saddle : near;
  return r <= large_g ? saddle : unclear;
}

/// Of the rest: the shortest sum that leaves out less than 1e-10 of W.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline RegionNumber<Real> fine_rest(Real r, Real x) {
  using namespace fine;
  using Number = RegionNumber<Real>;
  const Real xi = x * r * r;
  const PeakBound<Real> peak(r, xi);
  const bool is_deep = xi > Real(deep_xi);
  const bool beyond = xi > Real(greatest_xi);  // here x = w J² tells more
  Number n = scalar;
  n = (beyond ? x < Real(5450) : peak.below(is_deep, 17.3, 24.0)) ? Number(sum_48) : n;
  n = (beyond ? x < Real(2070) : peak.below(is_deep, 8.9, 13.1)) ? Number(sum_32) : n;
  return (beyond ? x < Real(345) : peak.below(is_deep, 2.42, 3.95)) ? Number(sum_16) : n;
}

/// A polynomial's region, or coarse::rest.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline RegionNumber<Real> coarse_region(Real r, Real x) {
  using namespace coarse;
  using Number = RegionNumber<Real>;
  const Real xi = x * r * r;
  const PeakBound<Real> peak(r, xi);
  Number far = peak.above(8.5) ? Number(saddle) : Number(rest);
  far = xi <= Real(greatest_xi) ? far : Number(rest);
  const Number near = r <= Real(1.0 / 9.0) ? Number(origin) : Number(rest);
  const Number unclear = x >= Real(15) ? far : near;
  return r <= Real(1.0 / 40.0) ? far : unclear;
}

/// Of the rest: the shortest sum that leaves out less than 3e-6 of W.
template <class Real>
[[nodiscard]] [[gnu::always_inline]] inline RegionNumber<Real> coarse_rest(Real r, Real x) {
  using namespace coarse;
  using Number = RegionNumber<Real>;
  const Real xi = x * r * r;
  const PeakBound<Real> peak(r, xi);
  const bool is_deep = xi > Real(deep_xi);
  const bool beyond = xi > Real(greatest_xi);  // here x = w J² tells more
  Number n = scalar;
  n = (beyond ? x < Real(2700) : peak.below(is_deep, 13.7, 18.1)) ? Number(sum_32) : n;
  n = (beyond ? x < Real(530) : peak.below(is_deep, 4.8, 6.8)) ? Number(sum_16) : n;
  return (beyond ? x < Real(95) : peak.below(is_deep, 1.36, 2.2)) ? Number(sum_8) : n;
}

}  // namespace goniofit::he_torrance
