#pragma once
// The slope distribution D in LT's normalisation, D = (pi/4) D_Beckmann(alpha = 2 m_e).

#include "../geometry/pair.h"
#include "scalar.h"

namespace goniofit {

/// tan² / m_e², 0 where tan² is 0: 1/m_e² alone may be infinite (sigma_e vanishes towards grazing), and 0 times it is
/// not what the mirror direction means.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T over_m_e2(const G& tan2, const T& log_m_e) {
  using namespace math;
  return select(tan2 > 0.0, T(tan2 * exp(-2.0 * log_m_e)), T(0.0));
}

/// Tier `rough-limit` (LT (10) with the dimensionless s): D = (|s|²/s_z)² exp(-tan²θ_b/(4 m_e²)) / (16 m_e² s_z²),
/// m_e = sigma_e/tau. The limit of He et al. 1991 for g >> 1. Two logarithms and one exponential together, because
/// 1/m_e² and the exponential each leave the range of doubles towards grazing while their product does not. Returns D
/// without its factor (|s|²/s_z)²/(16 s_z²), which no parameter touches: see slope_independent_factor.
template <class T, class G>
[[nodiscard]] [[gnu::always_inline]] inline T rough_limit_log(const T& log_m_e, const BasicPair<G>& p) {
  return -2.0 * log_m_e - 0.25 * over_m_e2(p.tan2_b, log_m_e);
}

/// (|s|²/s_z)²/(16 s_z²) = (1 + tan²θ_b)²/16.
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G slope_independent_factor(const BasicPair<G>& p) {
  const G sec2 = 1.0 + p.tan2_b;
  return sec2 * sec2 * 0.0625;
}

}  // namespace goniofit
