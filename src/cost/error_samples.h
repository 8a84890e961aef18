#pragma once
// Where models are compared: at plain random pairs f of a smooth surface is 1e-100 and less, and a relative error there
// says nothing. Half of the directions are uniform over the hemisphere, half are drawn from the reference's lobe.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../brdf/material.h"
#include "../geometry/direction_batch.h"
#include "../geometry/domain.h"

namespace goniofit {

struct ErrorSettings {
  std::size_t incidences = 17;    ///< even steps over the domain, both ends among them (one: its middle)
  std::size_t directions = 512;   ///< drawn for each; those that fall outside the domain are left out
  bool random_incidence = false;  ///< incidence angles uniformly random in as many equal strata instead
  std::uint64_t seed = 1;
};

/// Directions in the order of their incidences. The azimuth of incidence is random: it matters to anisotropic surfaces.
struct ErrorSamples {
  std::vector<double> theta_i_deg;
  std::vector<std::size_t> first;  ///< of each incidence among the directions, and their number at the end
  DirectionBatch directions;
  std::vector<double> weights;  ///< cos theta_r / density of each direction
  double drawn;                 ///< directions an incidence: sum of weights * f / drawn estimates a reflectance
  DirectionBatch mirrors;       ///< the mirror direction of each incidence
  double theta_r_max_deg;       ///< of the domain: mirror directions beyond it do not count
  double solid_angle_sr;        ///< of the source: what gives coh a height
};

/// `reference` without its coh draws the lobes. Errors: those of validate(domain).
[[nodiscard]] ErrorSamples error_samples(const Material& reference, const Domain& domain,
                                         const ErrorSettings& settings);

}  // namespace goniofit
