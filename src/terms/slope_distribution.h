#pragma once
// The slope distribution D in LT's normalisation, D = (pi/4) D_Beckmann(alpha = 2 m_e). Tier `rough-limit`, LT (10)
// with the dimensionless s, is (|s|²/s_z)² exp(-y) / (16 m_e² s_z²), y = tan²θ_b/(4 m_e²), m_e = sigma_e/tau: the limit
// of He et al. 1991 for g >> 1. 1/m_e² and the exponential each leave the range of doubles towards grazing while their
// product does not, so what varies with the shape is carried as a logarithm (log_lobe in brdf/surface_shape.h) beside
// slope_independent_factor.

#include "../geometry/pair.h"
#include "log1p_ratio.h"
#include "scalar.h"

namespace goniofit {

/// tan² / m_e², 0 where tan² is 0: 1/m_e² alone may be infinite (sigma_e vanishes towards grazing), and 0 times it is
/// not what the mirror direction means.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T over_m_e2(const G& tan2, const T& log_m_e) {
  using namespace math;
  return select(tan2 > 0.0, T(tan2 * exp(-2.0 * log_m_e)), T(0.0));
}

/// Tier `student-t` (Ribardière et al. 2017), D = (γ-1)^γ α^(2γ-2) / (π cos⁴θ_b ((γ-1)α² + tan²θ_b)^γ) with α = 2 m_e
/// and the tail γ > 1: what stands for exp(-y) of tier `rough-limit`, y = tan²θ_b/(4 m_e²), is (1 + y/(γ-1))^-γ.
/// Returns its logarithm -γ ln(1 + y/(γ-1)): Beckmann's -y as γ grows, and GGX at γ = 2. Right to 3 eps, and smooth,
/// for γ - 1 from 1e-6 to 1e12 and y from 0 to 1e300.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T student_t_exponent(const T& y, const T& tail) {
  const T n = tail - 1.0;
  return -(1.0 + 1.0 / n) * scaled_log1p(y, n);
}

/// The same of y e^growth. With growth = ln(sigma²/sigma_e²) that leaves the range of doubles towards grazing, while D,
/// which falls with its γth power only, may still be of the order of 1. From e^600 y on (y > 1e-36 where it is not 0)
/// the 1 no longer counts, and what goes beyond is added to the logarithm.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T student_t_exponent(const T& y, const T& growth, const T& tail) {
  using namespace math;
  const T within = select(growth < 600.0, growth, T(600.0));
  const T beyond = select(y > 0.0, T(growth - within), T(0.0));
  return student_t_exponent(T(y * exp(within)), tail) - tail * beyond;
}

/// (|s|²/s_z)²/(16 s_z²) = (1 + tan²θ_b)²/16.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G slope_independent_factor(const BasicPair<G>& p) {
  const G sec2 = 1.0 + p.tan2_b;
  return sec2 * sec2 * 0.0625;
}

}  // namespace goniofit
