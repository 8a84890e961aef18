#pragma once
// The paper's four samples, as its tables give them (Li & Torrance 2005).

#include "brdf/material.h"

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

inline Surface surface(double sigma_um, double tau_um) {
  Surface s = slope_alone(sigma_um / tau_um);
  s.sigma_um = sigma_um;
  s.tau_um = tau_um;
  return s;
}

inline Material garnet_red_paint_13() {
  Material m;
  m.name = "Garnet Red Paint #13";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface = surface(0.70, 8.2);
  m.channels = {channel("R", 0.65, 1.7, 0, 0.59, 0, 0.10, 1.1), channel("G", 0.55, 1.7, 0, 0.72, 0, 0, 1.0),
                channel("B", 0.45, 1.7, 0, 0.69, 0, 0, 1.2)};
  return m;
}

/// Of which, as a fit without coh gives it, only the slope is known.
inline Material garnet_by_slope() {
  Material m = garnet_red_paint_13();
  m.surface = slope_alone(*m.surface.slope);
  return m;
}

inline Material laser_paper_73() {
  Material m;
  m.name = "Laser Paper #73";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface = surface(0.39, 5.4);
  m.channels = {channel("R", 0.65, 1.5, 0, 0.28, 0, 0.91, 1.9), channel("G", 0.55, 1.5, 0, 0.25, 0, 0.94, 2.0),
                channel("B", 0.45, 1.5, 0, 0.25, 0, 0.83, 1.7)};
  return m;
}

inline Material ground_glass_41() {
  Material m;
  m.name = "Aluminium-Coated Ground Glass #41";
  m.components = {Effect::dd, Effect::udf};
  m.surface = surface(0.86, 4.99);
  m.channels = {channel("R", 0.65, 1.47, 7.79, 0.45, 0.33, 0, 0), channel("G", 0.55, 0.958, 6.69, 0.44, 0.34, 0, 0),
                channel("B", 0.45, 0.618, 5.47, 0.44, 0.32, 0, 0)};
  return m;
}

inline Material smooth_aluminium_45() {
  Material m;
  m.name = "Aluminium-Coated Surface #45";
  m.components = {Effect::coh, Effect::dd};
  m.surface = surface(0.23, 9.9);
  m.channels = {channel("550nm", 0.55, 0.958, 6.69, 1.0, 0, 0, 0)};
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
