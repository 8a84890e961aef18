#pragma once
// Cook & Torrance 1982: f = k_d/pi + k_s F D G/(4 cos_i cos_r), with Beckmann's D and the V-cavity G,
//
//   G = min(1, 2 (N·H)(N·V)/(V·H), 2 (N·H)(N·L)/(V·H)).
//
// Their printed F D G/(pi cos_i cos_r) goes with a D without its 1/pi: four times this one. In the common normalisation
// used here the facets' projected area is 1 and k_s = 1 is a surface that loses nothing but F and G.

#include <memory>

#include "lobes.h"

namespace goniofit {

/// G/(4 cos_i cos_r), the quotient taken before it can be 0/0: of the two shadowed forms the smaller is
/// s_z/(|s|² max(cos_i, cos_r)).
template <class G>
[[nodiscard]] [[gnu::always_inline]] inline G v_cavity_over_cosines(const BasicPair<G>& p) {
  using namespace math;
  const G unshadowed = 0.25 / (p.cos_i * p.cos_r);
  const G shadowed = p.s_z / ((p.s_h2 + p.s_z * p.s_z) * select(p.cos_i > p.cos_r, p.cos_i, p.cos_r));
  return select(shadowed < unshadowed, shadowed, unshadowed);
}

struct CookTorrance {
  static constexpr std::size_t columns = 2, parameters = 1;
  template <class T, class G>
  [[gnu::always_inline]] static void factors(const BasicPair<G>& p, const T* z, T* values) {
    values[0] = T(white_lambert<G>());
    values[1] = beckmann_distribution(z[0], p) * v_cavity_over_cosines(p);
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_cook_torrance();

}  // namespace goniofit
