#pragma once
// The model in double as a textbook prints it: vectors from angles in radians, 1 - pow(1-c, q), tan² from acos, D with
// its 1/m² formed, W term by term with factorials. What stability_test.cpp holds up against the program's forms.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "columns.h"

namespace goniofit::truth::naive {

inline constexpr double pi = std::numbers::pi;
inline constexpr double solid_angle_sr = 0.0005;

struct Vec {
  double x, y, z;
};
[[nodiscard]] inline double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline Vec direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
[[nodiscard]] inline double radians(double degrees) { return degrees * pi / 180.0; }

/// One row: its inputs, and what all terms read of the directions.
struct Sample {
  const Inputs& in;
  double theta_i = radians(in.theta_i), phi_i = radians(in.phi_i);
  double theta_r = radians(in.theta_r), phi_r = radians(in.phi_r);
  Vec l = direction(theta_i, phi_i), v = direction(theta_r, phi_r);
  Vec s{l.x + v.x, l.y + v.y, l.z + v.z};
  double s2 = dot(s, s);
  double u = dot(v, s) / std::sqrt(s2);
  double theta_h = std::acos(s.z / std::sqrt(s2));
};

// ---- Fresnel -------------------------------------------------------------------------------------------------------

/// The (a, b) form (Cook & Torrance 1982 and others).
[[nodiscard]] inline double fresnel_exact(double n, double kappa, double u) {
  const double sin2 = 1.0 - u * u;
  const double p = n * n - kappa * kappa - sin2;
  const double modulus = std::sqrt(p * p + 4.0 * n * n * kappa * kappa);
  const double a = std::sqrt(0.5 * (modulus + p));
  const double b = std::sqrt(0.5 * (modulus - p));
  const double sin_tan = sin2 / u;
  const double rs = ((a - u) * (a - u) + b * b) / ((a + u) * (a + u) + b * b);
  const double rp = rs * ((a - sin_tan) * (a - sin_tan) + b * b) / ((a + sin_tan) * (a + sin_tan) + b * b);
  return 0.5 * (rs + rp);
}
[[nodiscard]] inline double fresnel_schlick(double n, double kappa, double u) {
  const double f0 = ((n - 1.0) * (n - 1.0) + kappa * kappa) / ((n + 1.0) * (n + 1.0) + kappa * kappa);
  return f0 + (1.0 - f0) * std::pow(1.0 - u, 5.0);
}

// ---- Shadowing and effective roughness -----------------------------------------------------------------------------

[[nodiscard]] inline double shadowing_lt(double m, double c) { return 1.0 - std::pow(1.0 - c, 1.0 / m); }
[[nodiscard]] inline double shadowing_smith(double m, double c) {
  const double a = 1.0 / std::tan(std::acos(c)) / (2.0 * m);
  const double lambda = 0.5 * (std::exp(-a * a) / (a * std::sqrt(pi)) - std::erfc(a));
  return (1.0 - 0.5 * std::erfc(a)) / (1.0 + lambda);
}
[[nodiscard]] inline double shadowing_schlick(double m, double c) {
  const double rms = std::sqrt(2.0) * m;
  const double k = std::sqrt(2.0 * rms * rms / pi);
  return c / (c - k * c + k);
}

/// sigma_e / sigma.
[[nodiscard]] inline double roughness_lt(double m_i, double m_r, double c_i, double c_r) {
  return std::pow(1.0 - std::pow(1.0 - c_i, 1.6 / m_i), 0.1 / m_i) *
         std::pow(1.0 - std::pow(1.0 - c_r, 1.6 / m_r), 0.1 / m_r);
}
/// The transcendental equation for z0/sigma by fixed-point iteration.
[[nodiscard]] inline double roughness_he(double m_i, double m_r, double c_i, double c_r) {
  const auto depth = [](double m, double c) {
    const double theta = std::acos(c);
    return std::tan(theta) * std::erfc(1.0 / std::tan(theta) / (2.0 * m));
  };
  const double k = depth(m_i, c_i) + depth(m_r, c_r);
  double z = 0.0;
  for (int i = 0; i < 100; ++i) z = std::sqrt(2.0 / pi) * 0.25 * k * std::exp(-0.5 * z * z);
  return 1.0 / std::sqrt(1.0 + z * z);
}

/// Slopes along the azimuths of L and V and along the axes.
struct Slopes {
  double i, r, x, y;
};
[[nodiscard]] inline Slopes isotropic(const Sample& s) { return {s.in.slope, s.in.slope, s.in.slope, s.in.slope}; }
[[nodiscard]] inline Slopes anisotropic(const Sample& s) {
  const auto along = [&](double phi) { return std::hypot(std::cos(phi) * s.in.slope, std::sin(phi) * s.in.slope_y); };
  return {along(s.phi_i), along(s.phi_r), s.in.slope, s.in.slope_y};
}

enum class Tier { lt, he };
[[nodiscard]] inline double shadowing(Tier tier, const Slopes& m, const Sample& s) {
  return tier == Tier::lt ? shadowing_lt(m.i, s.l.z) * shadowing_lt(m.r, s.v.z)
                          : shadowing_smith(m.i, s.l.z) * shadowing_smith(m.r, s.v.z);
}
[[nodiscard]] inline double roughness(Tier tier, const Slopes& m, const Sample& s) {
  return tier == Tier::lt ? roughness_lt(m.i, m.r, s.l.z, s.v.z) : roughness_he(m.i, m.r, s.l.z, s.v.z);
}

// ---- Distributions -------------------------------------------------------------------------------------------------

[[nodiscard]] inline double jacobian(const Sample& s) { return s.s2 / s.s.z * (s.s2 / s.s.z); }

[[nodiscard]] inline double d_rough(const Sample& s, double m_e) {
  const double tangent = std::tan(s.theta_h);
  return jacobian(s) / (16.0 * m_e * m_e * s.s.z * s.s.z) * std::exp(-tangent * tangent / (4.0 * m_e * m_e));
}
[[nodiscard]] inline double d_rough_anisotropic(const Sample& s, double m_x, double m_y) {
  const double y = (s.s.x * s.s.x / (m_x * m_x) + s.s.y * s.s.y / (m_y * m_y)) / (4.0 * s.s.z * s.s.z);
  return jacobian(s) / (16.0 * m_x * m_y * s.s.z * s.s.z) * std::exp(-y);
}
[[nodiscard]] inline double d_student(const Sample& s, double m_e) {
  const double tail = s.in.tail;
  const double alpha = 2.0 * m_e;
  const double tangent = std::tan(s.theta_h);
  return 0.25 * pi * std::pow(tail - 1.0, tail) * std::pow(alpha, 2.0 * tail - 2.0) /
         (pi * std::pow(std::cos(s.theta_h), 4.0) * std::pow((tail - 1.0) * alpha * alpha + tangent * tangent, tail));
}

[[nodiscard]] inline double phase_variance(const Sample& s, double sigma_e) {
  const double phase = 2.0 * pi * sigma_e / s.in.wavelength_um * s.s.z;
  return phase * phase;
}
[[nodiscard]] inline double lobe_argument(const Sample& s, const Slopes& m) {
  const double x = s.s.x * s.in.sigma_um / m.x;
  const double y = s.s.y * s.in.sigma_um / m.y;
  const double wave_number = 2.0 * pi / s.in.wavelength_um;
  return wave_number * wave_number * (x * x + y * y) / 4.0;
}
/// Until the terms no longer count.
[[nodiscard]] inline double lobe_sum(double g, double x) {
  double sum = 0.0;
  double factorial = 1.0;
  for (int j = 1; j <= 1000; ++j) {
    factorial *= j;
    const double term = std::pow(g, j) * std::exp(-g) / (factorial * j) * std::exp(-x / j);
    sum += term;
    if (std::isnan(sum) || (j > g && term < 1e-17 * sum)) break;
  }
  return sum;
}
[[nodiscard]] inline double d_he(const Sample& s, const Slopes& m, double sigma_e) {
  const double w = lobe_sum(phase_variance(s, sigma_e), lobe_argument(s, m));
  const double tau_x = s.in.sigma_um / m.x;
  const double tau_y = s.in.sigma_um / m.y;
  return jacobian(s) * pi * pi * tau_x * tau_y / (4.0 * s.in.wavelength_um * s.in.wavelength_um) * w;
}

// ---- Effects -------------------------------------------------------------------------------------------------------

[[nodiscard]] inline double dd(const Sample& s, double shadow, double d) { return shadow * d / (pi * s.l.z * s.v.z); }
[[nodiscard]] inline double dd_rough(Tier tier, const Sample& s) {
  const Slopes m = isotropic(s);
  return dd(s, shadowing(tier, m, s), d_rough(s, roughness(tier, m, s) * m.x));
}
[[nodiscard]] inline double dd_rough_anisotropic(const Sample& s) {
  const Slopes m = anisotropic(s);
  const double ratio = roughness(Tier::lt, m, s);
  return dd(s, shadowing(Tier::lt, m, s), d_rough_anisotropic(s, ratio * m.x, ratio * m.y));
}
[[nodiscard]] inline double dd_student(const Sample& s) {
  const Slopes m = isotropic(s);
  return dd(s, shadowing(Tier::lt, m, s), d_student(s, roughness(Tier::lt, m, s) * m.x));
}
[[nodiscard]] inline double dd_he(const Sample& s, const Slopes& m) {
  return dd(s, shadowing(Tier::he, m, s), d_he(s, m, roughness(Tier::he, m, s) * s.in.sigma_um));
}

/// tan² of LT's theta_f over the squared slope it meets.
[[nodiscard]] inline double fs_exponent(const Vec& l, const Vec& v, double phi, double m_x, double m_y) {
  const double theta_f = std::acos(-(v.x * l.x + v.y * l.y) / std::hypot(l.x, l.y));
  const double tangent = std::tan(theta_f);
  const double x = std::cos(phi) / m_x;
  const double y = std::sin(phi) / m_y;
  return tangent * tangent * (x * x + y * y) / 16.0;
}
[[nodiscard]] inline double fs(const Sample& s, const Slopes& m, bool reciprocal) {
  if (s.v.x * s.l.x + s.v.y * s.l.y > 0.0) return 0.0;
  const double ratio = roughness(Tier::lt, m, s);
  double exponent = fs_exponent(s.l, s.v, s.phi_i, ratio * m.x, ratio * m.y);
  if (reciprocal) exponent = 0.5 * (exponent + fs_exponent(s.v, s.l, s.phi_r, ratio * m.x, ratio * m.y));
  return (1.0 - s.l.z) * (1.0 - s.v.z) / pi * std::exp(-exponent);
}

[[nodiscard]] inline double coh(const Sample& s, Tier tier) {
  const Vec mirror{-s.l.x, -s.l.y, s.l.z};
  if (dot(mirror, s.v) < 1.0 - solid_angle_sr / (2.0 * pi)) return 0.0;
  const Slopes m = isotropic(s);
  const double g = phase_variance(s, roughness(tier, m, s) * s.in.sigma_um);
  return shadowing(tier, m, s) * std::exp(-g) / (s.l.z * solid_angle_sr);
}

[[nodiscard]] inline double transmissions(const Sample& s, bool exact) {
  const auto f = [&](double u) {
    return exact ? fresnel_exact(s.in.n, s.in.kappa, u) : fresnel_schlick(s.in.n, s.in.kappa, u);
  };
  return (1.0 - f(s.l.z)) * (1.0 - f(s.v.z));
}

// ---- Oren & Nayar --------------------------------------------------------------------------------------------------

/// Angles from the vectors.
struct Grooves {
  double alpha, beta, cos_delta, sigma2;
  explicit Grooves(const Sample& s)
      : alpha(std::max(std::acos(s.l.z), std::acos(s.v.z))),
        beta(std::min(std::acos(s.l.z), std::acos(s.v.z))),
        cos_delta((s.l.x * s.v.x + s.l.y * s.v.y) / (std::hypot(s.l.x, s.l.y) * std::hypot(s.v.x, s.v.y))),
        sigma2(radians(s.in.facet_slope_deg) * radians(s.in.facet_slope_deg)) {}
};
[[nodiscard]] inline double on_direct(const Sample& s) {
  const Grooves a(s);
  const double b = 2.0 * a.beta / pi;
  const double ratio = a.sigma2 / (a.sigma2 + 0.09);
  const double c1 = 1.0 - 0.5 * a.sigma2 / (a.sigma2 + 0.33);
  const double c2 = 0.45 * ratio * (a.cos_delta >= 0.0 ? std::sin(a.alpha) : std::sin(a.alpha) - b * b * b);
  const double product = 4.0 * a.alpha * a.beta / (pi * pi);
  const double c3 = 0.125 * ratio * product * product;
  return (c1 + a.cos_delta * c2 * std::tan(a.beta) +
          (1.0 - std::fabs(a.cos_delta)) * c3 * std::tan(0.5 * (a.alpha + a.beta))) /
         pi;
}
[[nodiscard]] inline double on_interreflection(const Sample& s) {
  const Grooves a(s);
  const double b = 2.0 * a.beta / pi;
  return 0.17 / pi * a.sigma2 / (a.sigma2 + 0.13) * (1.0 - a.cos_delta * b * b);
}
[[nodiscard]] inline double on_qualitative(const Sample& s) {
  const Grooves a(s);
  const double big_a = 1.0 - 0.5 * a.sigma2 / (a.sigma2 + 0.33);
  const double big_b = 0.45 * a.sigma2 / (a.sigma2 + 0.09);
  return (big_a + big_b * std::max(0.0, a.cos_delta) * std::sin(a.alpha) * std::tan(a.beta)) / pi;
}

// ---- Whole models --------------------------------------------------------------------------------------------------

[[nodiscard]] inline double f_lt(const Sample& s) {
  const double t = transmissions(s, false);
  return s.in.k_dd * fresnel_schlick(s.in.n, s.in.kappa, s.u) * dd_rough(Tier::lt, s) + s.in.k_udf / pi +
         s.in.k_uds * t / pi + s.in.k_fs * t * fs(s, isotropic(s), false);
}
[[nodiscard]] inline double f_ht(const Sample& s) {
  return s.in.k_dd * fresnel_exact(s.in.n, s.in.kappa, s.u) * dd_he(s, isotropic(s)) + s.in.k_udf / pi;
}
[[nodiscard]] inline double f_mixed(const Sample& s) {
  const double t = transmissions(s, true);
  return s.in.k_dd * fresnel_exact(s.in.n, s.in.kappa, s.u) * dd_student(s) + s.in.k_udf / pi + s.in.k_uds * t / pi +
         s.in.k_fs * t * fs(s, isotropic(s), true);
}

}  // namespace goniofit::truth::naive
