#pragma once
// The reflectance model, each quantity written plainly from its definition, on a multiprecision scalar R. Nothing here
// shares a formula, a shortcut or a rearrangement with src/: where the program uses expm1, Lambert's W or a table, this
// file has a power, a root to be found or a sum.
//
// Sources: LT = Li & Torrance 2005; HT = He, Torrance, Sillion & Greenberg 1991 with its errata; S94 = Schlick 1994;
// CT = Cook & Torrance 1982; R17 = Ribardière et al. 2017 (Student's t slopes). Equations that are printed wrong are
// given as corrected; each says so.
//
// COLUMNS of ordinary.csv and hard.csv (hard.csv has all; ln 0 is -inf; a logarithm beyond the range of doubles
// reads as -inf or inf).
//   Inputs, each the shortest decimal of a double, which is the exact input:
//     theta_i phi_i theta_r phi_r   degrees
//     slope slope_y                 m_x = sigma/tau_x (m where isotropic) and m_y = sigma/tau_y
//     sigma_um wavelength_um tail n kappa
//     facet_slope_deg               Oren & Nayar's sigma
//     k_dd k_udf k_uds k_fs         coefficients of the whole models
//     corner                        what goes wrong there if done naively (ordinary.csv: the stratum)
//   Terms:
//     F_exact F_schlick             at u = H.V
//     T_exact_i T_exact_r T_schlick_i T_schlick_r    1 - F at c_i, c_r
//     S_lt S_smith S_schlick S_v_cavity              S / (c_i c_r)
//     ln_sigma_e_lt ln_sigma_e_he   ln(sigma_e / sigma)
//     ln_g ln_x ln_W                HT's g (sigma_e of tier he) and x, and W(g, x)
//   Shape factors, natural logarithms:
//     ln_dd_lt                      S D / (pi c_i c_r): li-torrance, li-torrance, rough-limit
//     ln_dd_ht                      smith, he, he-torrance
//     ln_dd_student                 li-torrance, li-torrance, student-t
//     ln_dd_smith_rough             smith, he, rough-limit
//     ln_dd_aniso_lt ln_dd_aniso_ht as ln_dd_lt and ln_dd_ht with slope along x, slope_y along y (consistent form)
//     ln_fs_printed ln_fs_reciprocal                 (1-c_i)(1-c_r) exp(-tan²/(16 m_e²)) / pi, tier li-torrance
//     ln_fs_aniso_printed ln_fs_aniso_reciprocal
//     ln_coh_lt ln_coh_ht           S exp(-g) / (c_i dOmega) at dOmega = 0.0005 sr; -inf outside the cone
//     uds_schlick uds_exact         T(c_i) T(c_r) / pi
//     on_direct on_interreflection  Oren & Nayar (14) and (15) per rho and per rho²; on_qualitative: (17) per rho
//   Whole models (no coh):
//     ln_f_lt      schlick; k_dd dd_lt, k_udf, k_uds, k_fs (printed)
//     ln_f_ht      exact; k_dd dd_ht, k_udf
//     ln_f_mixed   exact; k_dd dd_student, k_udf, k_uds, k_fs (reciprocal)
//   Derivatives by central differences of step 1e-30 (ln W inside them differentiated term by term):
//     dln_dd_lt_dln_slope  dln_dd_ht_dln_slope  dln_dd_ht_dln_sigma  (the other of slope and sigma held)
//   Conditioning, in relative error of f:
//     conditioning_lt conditioning_ht   the largest change of ln f when an input moves by half an ulp, summed over the
//       four angles and slope (ht: and sigma): what rounding the inputs does to any formula. The tables take the
//       doubles as exact, so a careful formula may do better; none need.

#include <limits>
#include <stdexcept>

#include "multiprecision.h"

namespace goniofit::truth {

template <class R>
struct Vec {
  R x, y, z;
};

template <class R>
[[nodiscard]] R dot(const Vec<R>& a, const Vec<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class R>
[[nodiscard]] Vec<R> direction(const R& theta_deg, const R& phi_deg) {
  const R s = sin_deg(theta_deg);
  return {s * cos_deg(phi_deg), s * sin_deg(phi_deg), cos_deg(theta_deg)};
}

/// A pair of directions and what the terms read of it.
template <class R>
struct Geometry {
  R phi_i_deg, phi_r_deg;
  Vec<R> l, v, s;  ///< s = L + V, not normalised
  R u;             ///< H.V
  R tan2_b;        ///< tan² of the angle between H and N

  Geometry(const R& theta_i, const R& phi_i, const R& theta_r, const R& phi_r)
      : phi_i_deg(phi_i), phi_r_deg(phi_r), l(direction(theta_i, phi_i)), v(direction(theta_r, phi_r)) {
    s = {l.x + v.x, l.y + v.y, l.z + v.z};
    u = dot(v, s) / sqrt(dot(s, s));
    tan2_b = (square(s.x) + square(s.y)) / square(s.z);
  }
};

// ---- Fresnel -------------------------------------------------------------------------------------------------------

/// Fresnel's equations with Snell's complex cosine, unpolarised, N = n + i kappa.
template <class R>
[[nodiscard]] R fresnel_exact(const R& n, const R& kappa, const R& u) {
  const Complex<R> index{n, kappa};
  const Complex<R> cosine{u, R(0)};
  const Complex<R> sin2{1 - u * u, R(0)};
  const Complex<R> one{R(1), R(0)};
  const Complex<R> refracted = square_root(one - sin2 / (index * index));
  const R rs = squared_modulus((cosine - index * refracted) / (cosine + index * refracted));
  const R rp = squared_modulus((index * cosine - refracted) / (index * cosine + refracted));
  return (rs + rp) / 2;
}

/// S94 (15).
template <class R>
[[nodiscard]] R fresnel_schlick(const R& n, const R& kappa, const R& u) {
  const R f0 = fresnel_exact(n, kappa, R(1));
  const R w = 1 - u;
  return f0 + (1 - f0) * w * w * w * w * w;
}

// ---- Shadowing, one direction --------------------------------------------------------------------------------------

/// LT (6).
template <class R>
[[nodiscard]] R shadowing_lt(const R& slope, const R& c) {
  return 1 - pow(R(1 - c), R(1 / slope));
}

/// HT (25) with the e^(-a²) that (25) omits as printed: S_S = (1 - erfc(a)/2) / (1 + Lambda), a = cot/(2m).
template <class R>
[[nodiscard]] R shadowing_smith(const R& slope, const R& c) {
  const R sine = sqrt(1 - c * c);
  if (sine == 0) return R(1);  // the limit a -> infinity
  const R a = c / sine / (2 * slope);
  const R complement = complementary_error(a);
  const R lambda = (exp(-a * a) / (a * sqrt(pi<R>())) - complement) / 2;
  return (1 - complement / 2) / (1 + lambda);
}

/// S94 (19), with m = sqrt(2) slope there: k = sqrt(2 m²/pi).
template <class R>
[[nodiscard]] R shadowing_schlick(const R& slope, const R& c) {
  const R k = sqrt(2 * square(R(sqrt(R(2)) * slope)) / pi<R>());
  return c / (c - k * c + k);
}

/// CT's V-cavity attenuation, of both directions at once: min(1, 2 N.H N.V / V.H, 2 N.H N.L / V.H).
template <class R>
[[nodiscard]] R shadowing_v_cavity(const Geometry<R>& p) {
  const R nh = p.s.z / sqrt(dot(p.s, p.s));
  const R masked = 2 * nh * p.v.z / p.u;
  const R shadowed = 2 * nh * p.l.z / p.u;
  const R lower = masked < shadowed ? masked : shadowed;
  return lower < 1 ? lower : R(1);
}

// ---- Effective roughness, sigma_e / sigma --------------------------------------------------------------------------

/// LT (8); anisotropic with each direction's slope m: {[1-(1-c_i)^(1.6/m_i)]^(0.1/m_i)
/// [1-(1-c_r)^(1.6/m_r)]^(0.1/m_r)}.
template <class R>
[[nodiscard]] R effective_roughness_lt(const R& slope_i, const R& slope_r, const R& c_i, const R& c_r) {
  const R part_i = 1 - pow(R(1 - c_i), R(ratio<R>(8, 5) / slope_i));
  const R part_r = 1 - pow(R(1 - c_r), R(ratio<R>(8, 5) / slope_r));
  return pow(part_i, R(ratio<R>(1, 10) / slope_i)) * pow(part_r, R(ratio<R>(1, 10) / slope_r));
}

/// HT's K = tan(theta) erfc(cot(theta) / (2m)).
template <class R>
[[nodiscard]] R shadow_slope(const R& slope, const R& c) {
  const R sine = sqrt(1 - c * c);
  if (sine == 0) return R(0);
  return sine / c * complementary_error(R(c / sine / (2 * slope)));
}

/// HT (80): 1/sqrt(1 + (z0/sigma)²), z0 the root of sqrt(pi/2) z0 = sigma/4 (K_i + K_r) exp(-z0²/(2 sigma²)).
/// With t = z0/sigma and y = ln t the equation is y + e^(2y)/2 = ln[(K_i + K_r) / (4 sqrt(pi/2))], whose left side is
/// increasing and convex: Newton's steps from the right of the root decrease to it.
template <class R>
[[nodiscard]] R effective_roughness_he(const R& slope_i, const R& slope_r, const R& c_i, const R& c_r) {
  const R k = shadow_slope(slope_i, c_i) + shadow_slope(slope_r, c_r);
  if (k == 0) return R(1);
  const R right = log(R(k / (4 * sqrt(pi<R>() / 2))));
  R y = right;
  const R tolerance = pow(R(10), R(8 - std::numeric_limits<R>::digits10));
  for (int step = 0; step < 200; ++step) {
    const R t2 = exp(2 * y);
    const R change = (y + t2 / 2 - right) / (1 + t2);
    y -= change;
    if (abs(change) <= tolerance * (1 + abs(y))) return 1 / sqrt(1 + exp(2 * y));
  }
  throw std::runtime_error("effective_roughness_he: no root");
}

/// The slope of an anisotropic surface along an azimuth: LT (20)-(22) made consistent, 1/k(phi).
template <class R>
[[nodiscard]] R slope_along(const R& phi_deg, const R& slope_x, const R& slope_y) {
  return sqrt(square(R(cos_deg(phi_deg) * slope_x)) + square(R(sin_deg(phi_deg) * slope_y)));
}

// ---- Slope distributions: ln D in LT's normalisation ---------------------------------------------------------------

/// LT (10) with the dimensionless s, and its anisotropic form with m_e in both axes: m_ex = sigma_e/tau_x, m_ey =
/// sigma_e/tau_y (LT prints sigma).
template <class R>
[[nodiscard]] R log_d_rough_limit(const Geometry<R>& p, const R& m_ex, const R& m_ey) {
  const R sz2 = square(p.s.z);
  const R prefactor = square(R(dot(p.s, p.s) / p.s.z)) / (16 * m_ex * m_ey * sz2);
  return log(prefactor) - (square(p.s.x) / square(m_ex) + square(p.s.y) / square(m_ey)) / (4 * sz2);
}

/// R17 times pi/4 (LT's normalisation), alpha = 2 m_e:
/// (tail-1)^tail alpha^(2 tail-2) / (pi cos⁴ ((tail-1) alpha² + tan²)^tail).
template <class R>
[[nodiscard]] R log_d_student_t(const Geometry<R>& p, const R& tail, const R& m_e) {
  const R alpha2 = square(R(2 * m_e));
  const R cos2 = 1 / (1 + p.tan2_b);
  return tail * log(R(tail - 1)) + (tail - 1) * log(alpha2) - log(pi<R>()) - 2 * log(cos2) -
         tail * log(R((tail - 1) * alpha2 + p.tan2_b)) + log(R(pi<R>() / 4));
}

/// HT's g = [2 pi sigma_e / lambda (c_i + c_r)]².
template <class R>
[[nodiscard]] R phase_variance(const Geometry<R>& p, const R& sigma_e, const R& wavelength) {
  return square(R(2 * pi<R>() * sigma_e / wavelength * p.s.z));
}

/// HT's (v_xy tau)²/4 = (2 pi/lambda)² (s_x² tau_x² + s_y² tau_y²) / 4.
template <class R>
[[nodiscard]] R lobe_argument(const Geometry<R>& p, const R& tau_x, const R& tau_y, const R& wavelength) {
  return square(R(2 * pi<R>() / wavelength)) * (square(R(p.s.x * tau_x)) + square(R(p.s.y * tau_y))) / 4;
}

/// HT's ln D = ln[(|s|²/s_z)² pi² tau_x tau_y / (4 lambda²)] + ln W(g, x).
template <class R>
[[nodiscard]] R log_d_he_torrance(const Geometry<R>& p, const R& tau_x, const R& tau_y, const R& wavelength,
                                  const R& log_w) {
  const R prefactor = square(R(dot(p.s, p.s) / p.s.z)) * square(pi<R>()) * tau_x * tau_y / (4 * square(wavelength));
  return log(prefactor) + log_w;
}

// ---- Effects -------------------------------------------------------------------------------------------------------

enum class FsOrder { printed, reciprocal };

/// tan² of LT's theta_f over the squared slope it meets: cos theta_f = -V.L_h/|L_h|, 1/m_e² as the azimuth of L sees
/// it.
template <class R>
[[nodiscard]] R fs_exponent(const Vec<R>& l, const Vec<R>& v, const R& phi_deg, const R& m_ex, const R& m_ey) {
  const R cos_f = -(v.x * l.x + v.y * l.y) / sqrt(square(l.x) + square(l.y));
  const R tan2 = 1 / square(cos_f) - 1;
  return tan2 * (square(R(cos_deg(phi_deg) / m_ex)) + square(R(sin_deg(phi_deg) / m_ey))) / 16;
}

/// ln[(1-c_i)(1-c_r) exp(-...)/pi]; -inf where cos theta_f <= 0 and at L = N.
template <class R>
[[nodiscard]] R log_fs(const Geometry<R>& p, const R& m_ex, const R& m_ey, FsOrder order) {
  const bool forward = p.v.x * p.l.x + p.v.y * p.l.y < 0;
  const R reach = (1 - p.l.z) * (1 - p.v.z) / pi<R>();
  if (!forward || reach == 0) return log(R(0));
  R exponent = fs_exponent(p.l, p.v, p.phi_i_deg, m_ex, m_ey);
  if (order == FsOrder::reciprocal) exponent = (exponent + fs_exponent(p.v, p.l, p.phi_r_deg, m_ex, m_ey)) / 2;
  return log(reach) - exponent;
}

/// LT (16): ln[S e^(-g) / (c_i dOmega)] within acos(1 - dOmega/(2 pi)) of the mirror direction (LT (3) prints c_r for
/// dOmega), else -inf.
template <class R>
[[nodiscard]] R log_coh(const Geometry<R>& p, const R& shadowing, const R& g, const R& solid_angle) {
  const Vec<R> mirror{-p.l.x, -p.l.y, p.l.z};
  if (dot(mirror, p.v) < 1 - solid_angle / (2 * pi<R>())) return log(R(0));
  return log(R(shadowing / (p.l.z * solid_angle))) - g;
}

}  // namespace goniofit::truth
