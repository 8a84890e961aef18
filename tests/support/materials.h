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

inline Surface surface(double sigma_um, double tau_um) { return {sigma_um / tau_um, sigma_um, tau_um}; }

inline Material garnet_red_paint_13() {
  Material m;
  m.name = "Garnet Red Paint #13";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface = surface(0.70, 8.2);
  m.channels = {channel("R", 0.65, 1.7, 0, 0.59, 0, 0.10, 1.1), channel("G", 0.55, 1.7, 0, 0.72, 0, 0, 1.0),
                channel("B", 0.45, 1.7, 0, 0.69, 0, 0, 1.2)};
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

}  // namespace goniofit::test
