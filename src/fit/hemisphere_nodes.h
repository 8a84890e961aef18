#pragma once
// A directional-hemispherical reflectance as a weighted sum of BRDF values: the nodes of a quadrature over all
// directions of reflection, fixed beforehand, so that the sum is as linear in a model's coefficients and as
// differentiable by its shape as a reading of the BRDF.

#include <vector>

#include "../geometry/pair.h"

namespace goniofit {

struct HemisphereNodes {
  PairBatch pairs;
  std::vector<double> weight;  ///< cos(theta_r) d omega: the reflectance is sum weight * f
};

/// Light from theta_i in [0, 90) degrees at azimuth 0. The nodes lie on circles about the mirror direction whose radii
/// grow in proportion from 1e-4 on, so that lobes of every width meet as many of them; `mirror_cone_sr` > 0 puts an
/// edge where the coherent part ends, `both_sides` covers the azimuths of a surface that is not symmetric about the
/// plane of incidence. Against the panels of hemispherical_reflectance(), over all effects, slopes 1e-3 to 1 and
/// theta_i to 80 degrees, the error is 1.5e-3 at worst, and 6e-3 for a surface twelve times rougher across than along.
[[nodiscard]] HemisphereNodes hemisphere_nodes(double theta_i_deg, double mirror_cone_sr, bool both_sides);

}  // namespace goniofit
