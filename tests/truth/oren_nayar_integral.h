#pragma once
// Oren & Nayar 1994 (13): the facets' projected radiance integrated over all V-cavities, by brute force. Its integrand
// has kinks wherever a facet turns away, is half hidden or half shadowed; the panels end on them, and tanh-sinh nodes
// take the square-root onsets at panel ends. About 12 digits: kinks make 50 pointless, so this is in long double.

namespace goniofit::truth {

struct OrenNayarIntegral {
  long double direct = 0;           ///< f per rho
  long double interreflection = 0;  ///< f per rho²
};

/// phi_deg = phi_r - phi_i, 0 on the retro side. `level`: the nodes' step is 2^-level; 4 is good, 5 checks it.
[[nodiscard]] OrenNayarIntegral oren_nayar_integral(double theta_i_deg, double theta_r_deg, double phi_deg,
                                                    double facet_slope_deg, int level);

}  // namespace goniofit::truth
