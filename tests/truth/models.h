#pragma once
// The terms of definitions.h put together: shape factors at each combination of tiers that the tables hold, and whole
// models.

#include <array>

#include "columns.h"
#include "definitions.h"
#include "he_torrance_sum.h"

namespace goniofit::truth {

/// Inputs on the scalar R.
template <class R>
struct Quantities {
  R theta_i, phi_i, theta_r, phi_r, slope, slope_y, sigma, wavelength, tail, n, kappa, facet_slope_deg;
  R k_dd, k_udf, k_uds, k_fs;

  explicit Quantities(const Inputs& a)
      : theta_i(a.theta_i),
        phi_i(a.phi_i),
        theta_r(a.theta_r),
        phi_r(a.phi_r),
        slope(a.slope),
        slope_y(a.slope_y),
        sigma(a.sigma_um),
        wavelength(a.wavelength_um),
        tail(a.tail),
        n(a.n),
        kappa(a.kappa),
        facet_slope_deg(a.facet_slope_deg),
        k_dd(a.k_dd),
        k_udf(a.k_udf),
        k_uds(a.k_uds),
        k_fs(a.k_fs) {}
  [[nodiscard]] Geometry<R> geometry() const { return {theta_i, phi_i, theta_r, phi_r}; }
};

/// The slopes that a surface has: along the azimuths of L and V, and along its axes.
template <class R>
struct Slopes {
  R along_i, along_r, x, y;

  [[nodiscard]] static Slopes isotropic(const Quantities<R>& q) { return {q.slope, q.slope, q.slope, q.slope}; }
  [[nodiscard]] static Slopes anisotropic(const Quantities<R>& q) {
    return {slope_along(q.phi_i, q.slope, q.slope_y), slope_along(q.phi_r, q.slope, q.slope_y), q.slope, q.slope_y};
  }
};

/// S and sigma_e/sigma at one pair of tiers.
template <class R>
struct Attenuation {
  R shadowing;  ///< S(c_i) S(c_r)
  R roughness;  ///< sigma_e / sigma
};

template <class R>
[[nodiscard]] Attenuation<R> attenuation_lt(const Geometry<R>& p, const Slopes<R>& m) {
  return {shadowing_lt(m.along_i, p.l.z) * shadowing_lt(m.along_r, p.v.z),
          effective_roughness_lt(m.along_i, m.along_r, p.l.z, p.v.z)};
}

template <class R>
[[nodiscard]] Attenuation<R> attenuation_ht(const Geometry<R>& p, const Slopes<R>& m) {
  return {shadowing_smith(m.along_i, p.l.z) * shadowing_smith(m.along_r, p.v.z),
          effective_roughness_he(m.along_i, m.along_r, p.l.z, p.v.z)};
}

/// ln[S D / (pi c_i c_r)].
template <class R>
[[nodiscard]] R log_dd(const Geometry<R>& p, const R& shadowing, const R& log_d) {
  return log(R(shadowing / (pi<R>() * p.l.z * p.v.z))) + log_d;
}

/// dd at rough-limit with the given S and sigma_e.
template <class R>
[[nodiscard]] R log_dd_rough(const Geometry<R>& p, const Slopes<R>& m, const Attenuation<R>& a) {
  return log_dd(p, a.shadowing, log_d_rough_limit(p, R(a.roughness * m.x), R(a.roughness * m.y)));
}

/// g and x of the he-torrance tier: tau = sigma / slope along each axis.
template <class R>
struct LobeArguments {
  R tau_x, tau_y, g, x;

  LobeArguments(const Quantities<R>& q, const Geometry<R>& p, const Slopes<R>& m, const R& roughness)
      : tau_x(q.sigma / m.x),
        tau_y(q.sigma / m.y),
        g(phase_variance(p, R(roughness * q.sigma), q.wavelength)),
        x(lobe_argument(p, tau_x, tau_y, q.wavelength)) {}
};

/// dd at he-torrance, ln W given as a function of g and x.
template <class R, class LogW>
[[nodiscard]] R log_dd_ht(const Quantities<R>& q, const Geometry<R>& p, const Slopes<R>& m, const Attenuation<R>& a,
                          const LogW& log_w) {
  const LobeArguments<R> w(q, p, m, a.roughness);
  return log_dd(p, a.shadowing, log_d_he_torrance(p, w.tau_x, w.tau_y, q.wavelength, log_w(w.g, w.x)));
}

/// The logarithms of a whole model's components; -inf where one is absent.
template <class R>
using Components = std::array<R, 4>;

template <class R>
[[nodiscard]] R log_of_sum(const Components<R>& logs) {
  R largest = logs[0];
  for (const R& value : logs)
    if (value > largest) largest = value;
  if (!isfinite(largest)) return largest;
  R sum = 0;
  for (const R& value : logs) sum += exp(value - largest);
  return largest + log(sum);
}

/// dd + udf + uds + fs.
template <class R>
[[nodiscard]] Components<R> four_effects(const Quantities<R>& q, const R& fresnel, const R& transmissions,
                                         const R& log_dd_value, const R& log_fs_value) {
  return {log(R(q.k_dd * fresnel)) + log_dd_value, log(R(q.k_udf / pi<R>())), log(R(q.k_uds * transmissions / pi<R>())),
          log(R(q.k_fs * transmissions)) + log_fs_value};
}

/// LT as published.
template <class R>
[[nodiscard]] Components<R> components_lt(const Quantities<R>& q) {
  const Geometry<R> p = q.geometry();
  const Slopes<R> m = Slopes<R>::isotropic(q);
  const Attenuation<R> a = attenuation_lt(p, m);
  const R m_e = a.roughness * q.slope;
  const R transmissions = (1 - fresnel_schlick(q.n, q.kappa, p.l.z)) * (1 - fresnel_schlick(q.n, q.kappa, p.v.z));
  return four_effects(q, fresnel_schlick(q.n, q.kappa, p.u), transmissions, log_dd_rough(p, m, a),
                      log_fs(p, m_e, m_e, FsOrder::printed));
}

/// HT: dd and a uniform diffuse part.
template <class R, class LogW>
[[nodiscard]] Components<R> components_ht(const Quantities<R>& q, const LogW& log_w) {
  const Geometry<R> p = q.geometry();
  const Slopes<R> m = Slopes<R>::isotropic(q);
  const R minus_infinity = log(R(0));
  return {log(R(q.k_dd * fresnel_exact(q.n, q.kappa, p.u))) + log_dd_ht(q, p, m, attenuation_ht(p, m), log_w),
          log(R(q.k_udf / pi<R>())), minus_infinity, minus_infinity};
}

/// exact, li-torrance, li-torrance, student-t, with fs in its reciprocal form.
template <class R>
[[nodiscard]] Components<R> components_mixed(const Quantities<R>& q) {
  const Geometry<R> p = q.geometry();
  const Slopes<R> m = Slopes<R>::isotropic(q);
  const Attenuation<R> a = attenuation_lt(p, m);
  const R m_e = a.roughness * q.slope;
  const R transmissions = (1 - fresnel_exact(q.n, q.kappa, p.l.z)) * (1 - fresnel_exact(q.n, q.kappa, p.v.z));
  return four_effects(q, fresnel_exact(q.n, q.kappa, p.u), transmissions,
                      log_dd(p, a.shadowing, log_d_student_t(p, q.tail, m_e)),
                      log_fs(p, m_e, m_e, FsOrder::reciprocal));
}

}  // namespace goniofit::truth
