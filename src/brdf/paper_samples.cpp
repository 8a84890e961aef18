#include "brdf/paper_samples.h"

namespace goniofit {

namespace {

struct Coefficients {
  double dd, udf, uds, fs;
};

MaterialChannel channel(const char* name, double wavelength_um, double n, double kappa, const Coefficients& k) {
  MaterialChannel c;
  c.name = name;
  c.wavelength_um = wavelength_um;
  c.n = n;
  c.kappa = kappa;
  c.k = {k.dd, k.udf, k.uds, k.fs};
  return c;
}

}  // namespace

Surface rough_surface(double sigma_um, double tau_um) {
  return {.slope = sigma_um / tau_um, .sigma_um = sigma_um, .tau_um = tau_um};
}

Material garnet_red_paint_13() {
  Material m;
  m.name = "Garnet Red Paint #13";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface = rough_surface(0.70, 8.2);
  m.channels = {channel("R", 0.65, 1.7, 0.0, {.dd = 0.59, .udf = 0.0, .uds = 0.10, .fs = 1.1}),
                channel("G", 0.55, 1.7, 0.0, {.dd = 0.72, .udf = 0.0, .uds = 0.0, .fs = 1.0}),
                channel("B", 0.45, 1.7, 0.0, {.dd = 0.69, .udf = 0.0, .uds = 0.0, .fs = 1.2})};
  return m;
}

Material laser_paper_73() {
  Material m;
  m.name = "Laser Paper #73";
  m.components = {Effect::dd, Effect::uds, Effect::fs};
  m.surface = rough_surface(0.39, 5.4);
  m.channels = {channel("R", 0.65, 1.5, 0.0, {.dd = 0.28, .udf = 0.0, .uds = 0.91, .fs = 1.9}),
                channel("G", 0.55, 1.5, 0.0, {.dd = 0.25, .udf = 0.0, .uds = 0.94, .fs = 2.0}),
                channel("B", 0.45, 1.5, 0.0, {.dd = 0.25, .udf = 0.0, .uds = 0.83, .fs = 1.7})};
  return m;
}

Material ground_glass_41() {
  Material m;
  m.name = "Aluminium-Coated Ground Glass #41";
  m.components = {Effect::dd, Effect::udf};
  m.surface = rough_surface(0.86, 4.99);
  m.channels = {channel("R", 0.65, 1.47, 7.79, {.dd = 0.45, .udf = 0.33, .uds = 0.0, .fs = 0.0}),
                channel("G", 0.55, 0.958, 6.69, {.dd = 0.44, .udf = 0.34, .uds = 0.0, .fs = 0.0}),
                channel("B", 0.45, 0.618, 5.47, {.dd = 0.44, .udf = 0.32, .uds = 0.0, .fs = 0.0})};
  return m;
}

Material smooth_aluminium_45() {
  Material m;
  m.name = "Aluminium-Coated Surface #45";
  m.components = {Effect::coh, Effect::dd};
  m.surface = rough_surface(0.23, 9.9);
  m.channels = {channel("550nm", 0.55, 0.958, 6.69, {.dd = 1.0, .udf = 0.0, .uds = 0.0, .fs = 0.0})};
  return m;
}

std::array<Material, 4> paper_samples() {
  return {garnet_red_paint_13(), laser_paper_73(), ground_glass_41(), smooth_aluminium_45()};
}

}  // namespace goniofit
