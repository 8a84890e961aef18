#pragma once
// The effects as basis columns: value = coefficient * optics factor * shape factor.
//
//   effect  coefficient  optics factor       shape factor
//   coh     k_dd         F(u)                S exp(-g) / (cos_i dOmega) inside the mirror cone
//   dd      k_dd         F(u)                S D / (pi cos_i cos_r)
//   udf     k_udf        1                   1/pi
//   uds     k_uds        T(cos_i) T(cos_r)   1/pi
//   fs      k_fs         T(cos_i) T(cos_r)   (1-cos_i)(1-cos_r) exp(-tan²θ_f/(16 m_e²)) / pi
//   rough   rho          1                   of grooves, for light that met one facet, over pi
//           rho²         1                   the same of two facets
//
// Only the optics factor reads a channel's n and kappa, only the shape factor reads the surface and the wavelength.
// That is what makes a fit fast: shape factors are shared by channels, optics factors by every point of the search.

#include "../basis/basis.h"
#include "material.h"

namespace goniofit {

[[nodiscard]] constexpr OpticsFactor optics_factor_of(Coefficient c) noexcept {
  switch (c) {
    case Coefficient::k_dd:
      return OpticsFactor::fresnel;
    case Coefficient::k_uds:
    case Coefficient::k_fs:
      return OpticsFactor::transmission;
    case Coefficient::k_udf:
    case Coefficient::rho:
      break;
  }
  return OpticsFactor::one;
}

}  // namespace goniofit
