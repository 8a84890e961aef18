#pragma once
// The sum in He et al. 1991's D: W(g, x) = sum over j >= 1 of g^j e^(-g) / (j! j) e^(-x/j), by its terms.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "multiprecision.h"

namespace goniofit::truth {

/// ln W and its logarithmic derivatives, the series differentiated term by term.
template <class R>
struct LobeSum {
  R g, x;
  R log_w;
  R dlog_dg, dlog_dx;

  /// ln W near (g, x), to first order: exact for a central difference whose step is tiny.
  [[nodiscard]] R near(const R& other_g, const R& other_x) const {
    return log_w + dlog_dg * (other_g - g) + dlog_dx * (other_x - x);
  }
};

/// The largest term's j in double precision: the terms are log-concave in j, so that bisection on the ratio of
/// neighbours finds it. A few j off does no harm.
[[nodiscard]] inline double peak_of_terms(double g, double x) {
  const auto rises = [&](double j) { return std::log(g / (j + 1)) + std::log(j / (j + 1)) + x / (j * (j + 1)) > 0; };
  double below = 1;
  double above = 2;
  while (rises(above)) above *= 2;
  while (above - below > 1) {
    const double middle = std::floor((above + below) / 2);
    if (middle <= below) break;
    (rises(middle) ? below : above) = middle;
  }
  return std::max(1.0, below);
}

/// Summed both ways from the largest term, in its unit (terms leave even MPFR's range), until what remains, at most a
/// geometric series with the last ratio, is below 1e-60 of the sum. At 100 digits the exponents (up to 1e11) leave more
/// than 80 digits of each term.
template <class R>
[[nodiscard]] LobeSum<R> he_torrance_sum(const R& g_in, const R& x_in) {
  const Hundred g(g_in);
  const Hundred x(x_in);
  const Hundred peak(peak_of_terms(static_cast<double>(g), static_cast<double>(x)));
  const Hundred log_top = peak * log(g) - g - log_gamma(Hundred(peak + 1)) - log(peak) - x / peak;
  const Hundred enough("1e-60");
  Hundred sum = 0;
  Hundred sum_j = 0;      // of j * term
  Hundred sum_per_j = 0;  // of term / j
  const auto add = [&](const Hundred& j, const Hundred& poisson) {
    const Hundred term = poisson * peak / j * exp(x * (j - peak) / (peak * j));
    if (!(term > 0)) throw std::runtime_error("he_torrance_sum: a term out of range");
    sum += term;
    sum_j += j * term;
    sum_per_j += term / j;
    return term;
  };
  const auto negligible = [&](const Hundred& term, const Hundred& previous) {
    return term < previous && term * previous / (previous - term) < enough * sum;
  };

  Hundred previous = add(peak, Hundred(1));
  Hundred poisson = 1;
  for (Hundred j = peak + 1;; ++j) {
    poisson *= g / j;
    const Hundred term = add(j, poisson);
    if (negligible(term, previous)) break;
    previous = term;
  }
  poisson = 1;
  previous = 1;
  for (Hundred j = peak - 1; j >= 1; --j) {
    poisson *= (j + 1) / g;
    const Hundred term = add(j, poisson);
    if (negligible(term, previous)) break;
    previous = term;
  }
  return {g_in, x_in, R(log_top + log(sum)), R((sum_j / sum - g) / g), R(-sum_per_j / sum)};
}

}  // namespace goniofit::truth
