#pragma once
// Directional albedos of materials, by another quadrature than the library's hemispherical_reflectance.

#include "brdf/evaluator.h"

namespace goniofit::test {

/// The integral of f cos(theta_r) over the hemisphere, first channel, light at theta_i and azimuth phi_i.
///
/// Over the slopes (p, q) of the facets that mirror L into V, p = w_x t cos psi, q = w_y t sin psi with the widths of
/// the surface's own lobe, so that a lobe has the same width everywhere. V stays above the horizon while
/// L_z + 2 L_h·P - L_z |P|² > 0, which is an interval of t: no panel is cut by the edge of the domain. The mirror cones
/// of coh and of Schlick's Delta are taken by their height instead, 1e-3 off at 80 degrees for LT's smooth aluminium.
///
/// Twice the points of both variables change it by at most 1.1e-3 of itself (dd of slopes from 0.002 to 2, with an axis
/// ratio of 4 too, every tier but the series, from 0 to 89 degrees). The integral over grooves alone, which has no lobe
/// and takes its time, is left to hemispherical_reflectance.
[[nodiscard]] double directional_albedo(const Material& material, double theta_i_deg, double phi_i_deg = 0.0);

}  // namespace goniofit::test
