// Compiled for vectorisation and without the contraction of products and sums to fused operations: one pair and a batch
// of them give the same bits, on every processor.

#include "geometry/pair_of_angles.h"

#include <algorithm>
#include <cmath>

#include "geometry/lane_angles.h"
#include "support/vectorised.h"

namespace goniofit {

namespace {

using T = Lane<double>;
using Trigonometry = SineCosine<T>;

[[gnu::always_inline]] inline T square(T x) noexcept { return x * x; }
[[gnu::always_inline]] inline T octant_sine(T degrees) noexcept { return lane::octant_sine(degrees.v); }

// Of the two accurate numbers, the smaller one carries the digits: towards grazing ln(1 - c) is about -c. Nearest to
// the normal 1 - c is a denormal number, which lane::log does not read.
[[gnu::always_inline]] inline T log_one_minus(T cos, T one_minus_cos) noexcept {
  constexpr double least_normal = std::numeric_limits<double>::min();
  constexpr double raised_by = 0x1p54;
  const bool denormal = one_minus_cos < least_normal;
  const T normal = select(denormal, raised_by * one_minus_cos, one_minus_cos);
  const T x = select(cos < 0.5, 1.0 - cos, normal);
  const T from_one = select(cos < 0.5, -cos, normal - 1.0);
  const T log = T(lane::log(x.v, from_one.v)) - select(denormal, T(54.0 * 0.69314718055994531), T(0.0));
  return select(one_minus_cos > 0.0, log, T(log_of_zero));
}

// phi_r - phi_i in degrees and what rounding the difference of two large azimuths took off it: 1e-14° is 1e-12 of a
// lobe of slope 1e-3.
struct AzimuthStep {
  T delta, rest;
};
[[gnu::always_inline]] inline AzimuthStep azimuth_step(T phi_i, T phi_r) noexcept {
  const T difference = phi_r - phi_i;
  const T less = difference - phi_r;
  return {difference, (phi_r - (difference - less)) - (phi_i + less)};
}

/// Turned by a small angle in radians, to first order.
[[gnu::always_inline]] inline Trigonometry turned(Trigonometry a, T by) noexcept {
  return {a.sine + by * a.cosine, a.cosine - by * a.sine};
}

// cos ½(a + b). Where both are near 90° their sum has rounded away what the cosine is made of, and 90 - a has not.
[[gnu::always_inline]] inline T cos_half_sum(T a, T b, T cos_of_rounded_half) noexcept {
  const T from_grazing = octant_sine(0.5 * ((90.0 - a) + (90.0 - b)));
  return select(a + b > 90.0, from_grazing, cos_of_rounded_half);
}

// tan² of LT's theta_f for a viewer at sin/cos theta and azimuth difference delta: cos theta_f = -sin(theta)
// cos(delta), so the sine is made of cos(theta) and sin(delta) without a cancellation. Infinite where theta_f is 90°.
[[gnu::always_inline]] inline T tan2_forward(Trigonometry theta, Trigonometry delta) noexcept {
  return (square(theta.cosine) + square(theta.sine * delta.sine)) / square(theta.sine * delta.cosine);
}

[[gnu::always_inline]] inline BasicPair<T> pair_of(T ti, T phi_i, T tr, T phi_r) noexcept {
  const auto [rounded_delta, rest] = azimuth_step(phi_i, phi_r);
  const T turn = rest * (pi / 180.0);
  const Trigonometry i = sine_cosine_deg(ti);
  const Trigonometry r = sine_cosine_deg(tr);
  const Trigonometry delta = turned(sine_cosine_deg(rounded_delta), turn);
  const Trigonometry half = turned(sine_cosine_deg(0.5 * rounded_delta), 0.5 * turn);
  const Trigonometry mean = sine_cosine_deg(0.5 * (ti + tr));
  const T cos_mean = cos_half_sum(ti, tr, mean.cosine);
  const T sin_half_difference = octant_sine(0.5 * (ti - tr));
  const T half_difference = square(2.0 * sin_half_difference);  // 4 sin²

  BasicPair<T> p{};
  p.cos_i = i.cosine;
  p.cos_r = r.cosine;
  p.one_minus_cos_i = 2.0 * square(octant_sine(0.5 * ti));
  p.one_minus_cos_r = 2.0 * square(octant_sine(0.5 * tr));
  p.log_one_minus_cos_i = log_one_minus(p.cos_i, p.one_minus_cos_i);
  p.log_one_minus_cos_r = log_one_minus(p.cos_r, p.one_minus_cos_r);
  p.s_z = p.cos_i + p.cos_r;
  // |s_h|² = (sin_i - sin_r)² + 2 sin_i sin_r (1 + cos delta), both parts as squares: no cancellation at the mirror.
  p.s_h2 = half_difference * square(cos_mean) + 4.0 * i.sine * r.sine * square(half.cosine);
  // |L - V|² likewise, exact at the retro direction.
  const T difference2 = half_difference + 4.0 * i.sine * r.sine * square(half.sine);
  p.cos_h = lane::at_most(1.0, 0.5 * std::sqrt((p.s_h2 + square(p.s_z)).v));
  p.one_minus_cos_h = difference2 / (4.0 * (1.0 + p.cos_h));
  p.tan2_b = p.s_h2 / square(p.s_z);
  // The mirror of L has the same theta: its distance to V is |s_h|² and the difference of the two heights.
  const T height = -2.0 * mean.sine * sin_half_difference;  // cos_i - cos_r
  p.mirror_distance2 = p.s_h2 + square(height);
  p.forward = r.sine * delta.cosine < 0.0;
  p.tan2_f = select(p.forward, tan2_forward(r, delta), T(0.0));
  // At L = N the swapped theta_f is 90°; fs vanishes there through (1 - cos_i), a finite tangent keeps 0 * infinity
  // out.
  p.tan2_f_swapped = select(i.sine > 0.0, select(p.forward, tan2_forward(i, delta), T(0.0)), T(0.0));
  p.dot_h = i.sine * r.sine * delta.cosine;
  // s_h along the azimuth of L and across it: sin_i + sin_r cos delta with the mirror side's cancellation taken out.
  const T mirror_side = 2.0 * sin_half_difference * cos_mean + 2.0 * r.sine * square(half.cosine);
  const T along = select(delta.cosine < 0.0, mirror_side, i.sine + r.sine * delta.cosine);
  const T across = r.sine * delta.sine;
  const Trigonometry azimuth_i = sine_cosine_deg(phi_i);
  const Trigonometry azimuth_r = sine_cosine_deg(phi_r);
  p.s_x2 = square(along * azimuth_i.cosine - across * azimuth_i.sine);
  p.s_y2 = square(along * azimuth_i.sine + across * azimuth_i.cosine);
  p.cos2_phi_i = square(azimuth_i.cosine);
  p.sin2_phi_i = square(azimuth_i.sine);
  p.cos2_phi_r = square(azimuth_r.cosine);
  p.sin2_phi_r = square(azimuth_r.sine);
  return p;
}

template <class Real>
struct PairLoop {
  struct Arguments {
    const AnglePair* angles;
    std::size_t n;
    const std::array<Real*, pair_arrays>& arrays;
  };

  [[gnu::always_inline]] static void run(const Arguments& a) {
    const AnglePair* const angles = a.angles;
    const std::array<Real*, pair_arrays> to = a.arrays;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t j = 0; j < n; ++j) {
      const BasicPair<T> p =
          pair_of(angles[j].theta_i_deg, angles[j].phi_i_deg, angles[j].theta_r_deg, angles[j].phi_r_deg);
      to[0][j] = static_cast<Real>(p.cos_i.v);
      to[1][j] = static_cast<Real>(p.cos_r.v);
      to[2][j] = static_cast<Real>(p.one_minus_cos_i.v);
      to[3][j] = static_cast<Real>(p.one_minus_cos_r.v);
      to[4][j] = static_cast<Real>(p.log_one_minus_cos_i.v);
      to[5][j] = static_cast<Real>(p.log_one_minus_cos_r.v);
      to[6][j] = static_cast<Real>(p.s_z.v);
      to[7][j] = static_cast<Real>(p.s_h2.v);
      to[8][j] = static_cast<Real>(p.cos_h.v);
      to[9][j] = static_cast<Real>(p.one_minus_cos_h.v);
      to[10][j] = static_cast<Real>(p.tan2_b.v);
      to[11][j] = static_cast<Real>(p.mirror_distance2.v);
      to[12][j] = static_cast<Real>(p.tan2_f.v);
      to[13][j] = static_cast<Real>(p.tan2_f_swapped.v);
      to[14][j] = static_cast<Real>(p.dot_h.v);
      to[15][j] = static_cast<Real>(p.s_x2.v);
      to[16][j] = static_cast<Real>(p.s_y2.v);
      to[17][j] = static_cast<Real>(p.cos2_phi_i.v);
      to[18][j] = static_cast<Real>(p.sin2_phi_i.v);
      to[19][j] = static_cast<Real>(p.cos2_phi_r.v);
      to[20][j] = static_cast<Real>(p.sin2_phi_r.v);
      to[21][j] = p.forward ? Real(1) : Real(0);
    }
  }
};

bool is_far(const AnglePair& a) noexcept {
  const auto far = [](double degrees) { return std::fabs(degrees) > most_degrees; };
  return far(a.theta_i_deg) || far(a.phi_i_deg) || far(a.theta_r_deg) || far(a.phi_r_deg);
}
AnglePair wrapped(const AnglePair& a) noexcept {
  return {wrap_deg(a.theta_i_deg), wrap_deg(a.phi_i_deg), wrap_deg(a.theta_r_deg), wrap_deg(a.phi_r_deg)};
}

}  // namespace

Pair make_pair(const AnglePair& angles) noexcept {
  const AnglePair a = is_far(angles) ? wrapped(angles) : angles;
  const BasicPair<T> p = pair_of(a.theta_i_deg, a.phi_i_deg, a.theta_r_deg, a.phi_r_deg);
  return {p.cos_i.v,
          p.cos_r.v,
          p.one_minus_cos_i.v,
          p.one_minus_cos_r.v,
          p.log_one_minus_cos_i.v,
          p.log_one_minus_cos_r.v,
          p.s_z.v,
          p.s_h2.v,
          p.cos_h.v,
          p.one_minus_cos_h.v,
          p.tan2_b.v,
          p.mirror_distance2.v,
          p.tan2_f.v,
          p.tan2_f_swapped.v,
          p.dot_h.v,
          p.s_x2.v,
          p.s_y2.v,
          p.cos2_phi_i.v,
          p.sin2_phi_i.v,
          p.cos2_phi_r.v,
          p.sin2_phi_r.v,
          p.forward};
}

template <class Real>
void fill_arrays(std::span<const AnglePair> angles, const std::array<Real*, pair_arrays>& arrays) noexcept {
  const auto loop = Vectorised<PairLoop<Real>>::of(best_instruction_set());
  loop({angles.data(), angles.size(), arrays});
  for (std::size_t j = 0; j < angles.size(); ++j) {
    if (!is_far(angles[j])) continue;
    const AnglePair near = wrapped(angles[j]);
    std::array<Real*, pair_arrays> at = arrays;
    for (Real*& to : at) to += j;
    loop({&near, 1, at});
  }
}

template void fill_arrays(std::span<const AnglePair>, const std::array<double*, pair_arrays>&) noexcept;
template void fill_arrays(std::span<const AnglePair>, const std::array<float*, pair_arrays>&) noexcept;

}  // namespace goniofit
