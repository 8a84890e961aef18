#pragma once
// Lafortune, Foo, Torrance & Greenberg 1997: one to three generalised cosine lobes over a Lambert part,
//
//   f = k_d/pi + sum over lobes of max(0, C_x (L_x V_x + L_y V_y) + C_z L_z V_z)^n,   C_x = C_y < 0 (mirror lobes).
//
// As coefficient and shape: k the lobe's strength in a channel, n its exponent and h = (C_z/|C_x|)^n how much higher it
// stands at normal incidence than towards grazing, each lobe being
//
//   k (n+2)/pi (h^(1/n) L_z V_z - L_h·V_h)^n / (1 + h).
//
// At h = 1 that is k (n+2)/(2 pi) (R·V)^n, whose albedo at normal incidence is k. h rather than the ratio C_z/|C_x| is
// the parameter because a lobe feels the ratio's n-th power: the same steps of ln h serve every n, and the value stays
// below (n+2)/pi wherever h goes. Back to Lafortune's numbers:
//
//   C_x = C_y = -[k (n+2) / (pi (1 + h))]^(1/n),   C_z = -h^(1/n) C_x.
//
// Retro lobes (C_x > 0) are left out: beside a Lambert part and mirror lobes, scans without readings around the light
// cannot tell them.

#include <memory>

#include "lobes.h"

namespace goniofit {

/// z_n = ln n, z_h = ln h. The bracket's logarithm from x = (h^(1/n) - 1) cos_i cos_r - |V - R|²/2, what it differs
/// from 1 by, so that no digit of a narrow lobe is lost next to the mirror; far from it from the bracket itself, which
/// for L_h·V_h < 0 is a sum. (Where it vanishes on the retro side its error is round-off of its terms.)
template <class T, class G>
[[nodiscard]] T lafortune_lobe(const T& z_n, const T& z_h, const BasicPair<G>& p) {
  using namespace math;
  const T n = exp(z_n);
  const T surplus = expm1(z_h / n);  // C_z/|C_x| - 1
  const G cosines = p.cos_i * p.cos_r;
  const T x = surplus * cosines - 0.5 * p.mirror_distance2;
  const T bracket = (1.0 + surplus) * cosines - p.dot_h;
  if (bracket <= 0.0) return T(0.0);
  const T log_bracket = x > -0.5 ? T(log1p(x)) : T(log(bracket));
  return (n + 2.0) / pi_of<G>() * exp(n * log_bracket) / (1.0 + exp(z_h));
}

template <std::size_t lobes>
struct Lafortune {
  static constexpr std::size_t columns = 1 + lobes, parameters = 2 * lobes;
  template <class T, class G>
  static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    for (std::size_t i = 0; i < lobes; ++i) values[1 + i] = lafortune_lobe(z[2 * i], z[2 * i + 1], p);
  }
};

/// 1 to 3 lobes, else nullptr.
[[nodiscard]] std::unique_ptr<const Basis> make_lafortune(std::size_t lobes);

}  // namespace goniofit
