#pragma once
// Materials that tests share: the paper's four samples (brdf/paper_samples.h), and others made of them.

#include "brdf/material.h"
#include "brdf/paper_samples.h"

namespace goniofit::test {

inline MaterialChannel channel(const char* name, double wavelength_um, double n, double kappa, double k_dd,
                               double k_udf, double k_uds, double k_fs) {
  MaterialChannel c;
  c.name = name;
  c.wavelength_um = wavelength_um;
  c.n = n;
  c.kappa = kappa;
  c.k = {k_dd, k_udf, k_uds, k_fs};
  return c;
}

inline Surface slope_alone(double slope) {
  Surface s;
  s.slope = slope;
  return s;
}

inline Surface surface(double sigma_um, double tau_um) { return rough_surface(sigma_um, tau_um); }

using goniofit::garnet_red_paint_13;
using goniofit::ground_glass_41;
using goniofit::laser_paper_73;
using goniofit::smooth_aluminium_45;

/// Of which, as a fit without coh gives it, only the slope is known.
inline Material garnet_by_slope() {
  Material m = garnet_red_paint_13();
  m.surface = slope_alone(*m.surface.slope);
  return m;
}

/// The accurate model of He et al. 1991: exact Fresnel, Smith, sigma_e and their distribution.
inline Terms he_torrance_terms() {
  return {FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he, DistributionTier::he_torrance};
}

inline Material with_surface(Material m, double sigma_um, double tau_um) {
  m.surface = {.slope = sigma_um / tau_um, .sigma_um = sigma_um, .tau_um = tau_um};
  return m;
}

/// Ground glass with an aluminium film, by He et al.'s model: the parameters that LT's table 1 was simulated from.
inline Material he_ground_glass() {
  Material m = with_surface(ground_glass_41(), 0.90, 5.2);
  m.terms = he_torrance_terms();
  for (MaterialChannel& c : m.channels) {
    c.coefficient(Coefficient::k_udf) = 0.32;
    c.coefficient(Coefficient::k_dd) = 0.47;
  }
  return m;
}

/// A brushed metal: aluminium, twelve times rougher across its grooves than along them.
inline Material brushed_aluminium() {
  Material m = ground_glass_41();
  m.name = "brushed aluminium";
  m.surface = {.slope = 0.24, .slope_y = 0.02};
  return m;
}

/// A wall of plaster: grooves, with a thin directional part on top.
inline Material rough_plaster() {
  Material m = laser_paper_73();
  m.name = "rough plaster";
  m.components = {Effect::dd, Effect::rough};
  m.surface = {.slope = 0.3, .facet_slope_deg = 25.0};
  const double rho[3] = {0.82, 0.74, 0.61};
  for (std::size_t c = 0; c < 3; ++c) {
    m.channels[c].k = {};
    m.channels[c].coefficient(Coefficient::k_dd) = 0.3;
    m.channels[c].coefficient(Coefficient::rho) = rho[c];
  }
  return m;
}

/// The paper's paint with the long-tailed slopes of real coatings.
inline Material long_tailed_paint() {
  Material m = garnet_red_paint_13();
  m.terms.distribution = DistributionTier::student_t;
  m.surface.tail = 1.8;
  return m;
}

/// A peer with every kind of member: two shared parameters, two coefficients, Fresnel's term.
inline Material anisotropic_ggx() {
  Material m;
  m.name = "brushed lacquer";
  m.model = "ggx-anisotropic";
  m.parameters = {{"alpha_x", 0.1}, {"alpha_y", 0.3}};
  for (const char* name : {"R", "G"}) {
    MaterialChannel c;
    c.name = name;
    c.n = 1.6;
    c.kappa = 0.0;
    c.peer_k = {{"k_d", 0.25}, {"k_s", 0.75}};
    m.channels.push_back(c);
  }
  return m;
}

}  // namespace goniofit::test
