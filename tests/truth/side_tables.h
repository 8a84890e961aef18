#pragma once
// The two tables beside ordinary.csv and hard.csv.
//   lobe_sum.csv             g x (doubles), ln_W, dln_W_dln_g, dln_W_dln_x
//   oren_nayar_integral.csv  theta_i theta_r delta_phi facet_slope_deg (degrees), direct (per rho), interreflection
//                            (per rho²), error (largest relative difference from the next coarser nodes)

#include <string>
#include <vector>

#include "inputs.h"

namespace goniofit::truth {

[[nodiscard]] std::string lobe_header();
[[nodiscard]] std::string lobe_line(const LobeInputs& inputs);

struct IntegralInputs {
  double theta_i, theta_r, delta_phi, facet_slope_deg;
};
[[nodiscard]] std::vector<IntegralInputs> integral_inputs();
[[nodiscard]] std::string integral_header();
[[nodiscard]] std::string integral_line(const IntegralInputs& inputs);

}  // namespace goniofit::truth
