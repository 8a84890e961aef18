#pragma once
// Smith shadowing of a surface whose slopes follow Student's t (Ribardière et al. 2017), in the form of HT's.
//
// One component p of the slope has the density ∝ ((γ-1)α² + p²)^(½-γ), α = 2 slope. With μ = cot theta, Q its tail
// probability beyond μ and Λ = E[(p - μ)₊]/μ, S1 = (1 - Q)/(1 + Λ) = μ(1 - Q)/(μ(1 - Q) + J), where J = ∫_μ^∞ p dP is
// elementary: as for a Gaussian surface, no difference of near equals is left. In the variables
//
//   n = γ - 1,  a = μ/α,  w² = n ln(1 + a²/n),  ρ = Γ(n + ½)/(Γ(n) √n)
//
//   J = α ρ/(√π (2 - 1/n)) exp(-w² (1 - 1/(2n)))
//   1 - Q = ½ + ρ/√π ∫_0^w exp(-v²) h(v²/n) dv,   h(x) = √(x/(1 - e^-x))
//
// every factor tends to that of HT's S1 as n grows (ρ and h to 1, w to a), the integrand is smooth for every n, and
// none of it needs more than exponentials and roots, so that the derivative by the tail comes with dual numbers.

#include <array>
#include <cstddef>

#include "log1p_ratio.h"
#include "scalar.h"

namespace goniofit {

/// The mean |slope| is infinite at this tail and below: Λ with it, and S1 is 0. Just above, S1 grows linearly with the
/// tail.
inline constexpr double smallest_tail_with_smith = 1.5;

namespace student_t {

/// Positive nodes and the weights of the Gauss-Legendre rule of 24 points on [-1, 1].
inline constexpr std::array<double, 12> nodes{0.06405689286260563,  0.191118867473616311, 0.315042679696163397,
                                              0.433793507626045127, 0.545421471388839563, 0.648093651936975546,
                                              0.740124191578554358, 0.820001985973902947, 0.886415527004401071,
                                              0.938274552002732798, 0.974728555971309474, 0.995187219997021311};
inline constexpr std::array<double, 12> weights{0.127938195346752159,  0.125837456346828303,  0.121670472927803391,
                                                0.115505668053725599,  0.107444270115965634,  0.0976186521041138844,
                                                0.0861901615319532743, 0.0733464814110802998, 0.0592985849154367833,
                                                0.0442774388174198077, 0.0285313886289336634, 0.0123412297999872002};

/// ρ(n) = Γ(n + ½)/(Γ(n) √n), n > 0, to 2e-16. Stirling's series of the quotient at w = n - ¼ is even in w: ln ρ = ½
/// ln(w/n) - Σ E_2j/(j 4^(2j+1) w^2j), E the Euler numbers. Below 12 the recurrence raises n first; above, it would
/// cost the derivative its digits.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T gamma_ratio(const T& n) {
  using namespace math;
  const bool raise = n < 12.0;
  const T w = select(raise, T(n + 11.75), T(n - 0.25));
  T falling = T(1.0);
  for (int k = 0; k < 12; ++k) {  // an integer, or a loop around this one would not vectorise
    const double step = k;
    falling = falling * ((n + step) / (n + (step + 0.5)));
  }
  const T v = 1.0 / (w * w);
  const T series =
      v * (1.0 / 64 -
           v * (5.0 / 2048 -
                v * (61.0 / 49152 - v * (1385.0 / 1048576 - v * (50521.0 / 20971520 - v * (2702765.0 / 402653184))))));
  return select(raise, T(falling * sqrt(w / n)), T(sqrt(1.0 - 0.25 / n))) * exp(series);
}

/// 1/k!, alternating, from k = 1.
inline constexpr auto exp_ratio_terms = [] {
  std::array<double, 15> out{};
  double term = 1.0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = term;
    term /= -(static_cast<double>(k) + 2.0);
  }
  return out;
}();

/// (1 - e^-x)/x for 0 <= x <= ½ by its series: the quotient would lose its derivative.
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T exp_ratio_series(const T& x) {
  T sum = T(exp_ratio_terms.back());
  for (std::size_t k = exp_ratio_terms.size() - 1; k-- > 0;) sum = sum * x + exp_ratio_terms[k];
  return sum;
}

/// The integral of exp(-v²) h(v²/n) over [0, w], w <= reach.
inline constexpr double reach = 6.0;
template <class T>
[[nodiscard]] [[gnu::always_inline]] inline T lit_integral(const T& w, const T& n) {
  using namespace math;
  const bool gaussian = n > 2.0 * reach * reach;  // x = v²/n <= ½ all over
  const auto integrand = [&](double node) {
    const T v = (0.5 + 0.5 * node) * w;
    const T v2 = v * v;
    const T x = v2 / n + 1e-30;  // not 0/0 where w² underflows
    const T ratio = gaussian ? exp_ratio_series(x) : T(-expm1(-x) / x);
    return T(exp(-v2) / sqrt(ratio));
  };
  T sum = T(0.0);
#pragma GCC unroll 12  // left as a loop it would keep the one over directions from being vectorised
  for (std::size_t k = 0; k < nodes.size(); ++k) sum = sum + weights[k] * (integrand(-nodes[k]) + integrand(nodes[k]));
  return 0.5 * w * sum;
}

}  // namespace student_t

/// S1(c)/c, right to 1e-15 for tails from 2.2, to 1e-12 from 1.7 and to 2e-11 from 1.5, its derivatives by slope and
/// tail to 1e-12. It costs twenty times the Gaussian one, as a quadrature does. Errors: none; 0 for a tail at or below
/// smallest_tail_with_smith.
template <class T, class G>
[[nodiscard]] inline T shadowing_student_t_over_cosine(const T& slope, const T& tail, const G& c, const G& s) {
  using namespace math;
  const T n = tail - 1.0;
  const T width =
      2.0 * slope * s + 1e-100 * c;  // at the normal a is large instead of infinite; nowhere else is it felt
  const T a = c / width;
  const T x = a * a / n;
  const T w = select(x < 0.5, T(a * sqrt(log1p_ratio_series(x))), T(sqrt(n * log1p(x))));
  const T rho = student_t::gamma_ratio(n) / root_pi_of<T>();
  const T cut = select(w < student_t::reach, w, T(student_t::reach));
  const T lit = 0.5 + rho * student_t::lit_integral(cut, n);
  const T finite = 2.0 - 1.0 / n;  // times J: finite where Λ is not
  const T above = select(finite < 0.0, T(0.0), finite);
  return above * lit / (above * c * lit + width * rho * exp(-w * w * (0.5 * above)));
}

}  // namespace goniofit
