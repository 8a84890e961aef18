#pragma once
// The densities that a Sampler mixes: each draws a direction V for a given L from two numbers in [0, 1), and knows its
// own density of V per solid angle. A drawn V may lie below the horizon (facets, cone): the density there is the
// caller's to leave out.

#include <cstdint>

#include "../geometry/direction.h"

namespace goniofit {

/// Proportional to cos theta_r: exact for Lambert's law.
struct CosineLobe {
  [[nodiscard]] static Direction draw(double u1, double u2) noexcept;
  [[nodiscard]] static double density(const Direction& v) noexcept;
};

/// Uniform in the cone of the given solid angle about the mirror direction of L: exact for coh.
struct ConeLobe {
  double solid_angle_sr;
  [[nodiscard]] Direction draw(const Direction& l, double u1, double u2) const noexcept;
  [[nodiscard]] double density(const Direction& l, const Direction& v) const noexcept;
};

enum class FacetSlopes : std::uint8_t {
  gaussian,    ///< Beckmann
  long_tailed  ///< GGX, Student's t with tail 2
};

/// The reflection at facets as L sees them (their projected area towards L: Heitz & d'Eon 2014). The density of V is
/// D(H) / (4 A(L)), A = integral of D(H) max(0, L·H), so that F S D / (4 cos_i cos_r) leaves weights F S A / cos_i
/// without a D in them.
struct FacetLobe {
  FacetSlopes slopes;
  double alpha_x, alpha_y;  ///< sqrt(2) times the RMS slope where slopes are gaussian
  [[nodiscard]] Direction draw(const Direction& l, double u1, double u2) const noexcept;
  [[nodiscard]] double density(const Direction& l, const Direction& v) const noexcept;
};

/// About the forward horizontal direction, for fs: exp(-tan²theta_f / width²) cos theta_r, as the slopes
/// V_z/V_f ~ Rayleigh, V_across/V_f ~ normal of V against that direction. 0 on the retro side.
struct ForwardLobe {
  double width;
  [[nodiscard]] Direction draw(const Direction& l, double u1, double u2) const noexcept;
  [[nodiscard]] double density(const Direction& l, const Direction& v) const noexcept;
};

}  // namespace goniofit
