#include "geometry/pair.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

namespace {

double square(double x) noexcept { return x * x; }

// Of the two accurate numbers, the smaller one carries the digits: towards grazing ln(1 - c) is about -c.
double log_one_minus(double cos, double one_minus_cos) noexcept {
  if (cos < 0.5) return std::log1p(-cos);
  return one_minus_cos > 0.0 ? std::log(one_minus_cos) : log_of_zero;
}

// tan² of LT's theta_f for a viewer at sin/cos theta and azimuth difference delta: cos theta_f = -sin(theta)
// cos(delta), so the sine is made of cos(theta) and sin(delta) without a cancellation. Infinite where theta_f is 90°.
double tan2_forward(double sin_theta, double cos_theta, double cos_delta, double sin_delta) noexcept {
  const double c2 = square(sin_theta * cos_delta);
  return (square(cos_theta) + square(sin_theta * sin_delta)) / c2;
}

}  // namespace

AnglePair in_plane(double theta_i_deg, double signed_theta_r_deg) noexcept {
  return {theta_i_deg, 0.0, std::fabs(signed_theta_r_deg), signed_theta_r_deg < 0.0 ? 0.0 : 180.0};
}

AnglePair swapped(const AnglePair& angles) noexcept {
  return {angles.theta_r_deg, angles.phi_r_deg, angles.theta_i_deg, angles.phi_i_deg};
}

Pair make_pair(const AnglePair& a) noexcept {
  const double ti = a.theta_i_deg;
  const double tr = a.theta_r_deg;
  const double delta = wrap_deg(a.phi_r_deg - a.phi_i_deg);
  const double sin_i = sin_deg(ti);
  const double sin_r = sin_deg(tr);
  const double cos_delta = cos_deg(delta);
  const double sin_delta = sin_deg(delta);
  const double half_difference = square(2.0 * sin_deg(0.5 * (ti - tr)));  // 4 sin²

  Pair p{};
  p.cos_i = cos_deg(ti);
  p.cos_r = cos_deg(tr);
  p.one_minus_cos_i = 2.0 * square(sin_deg(0.5 * ti));
  p.one_minus_cos_r = 2.0 * square(sin_deg(0.5 * tr));
  p.log_one_minus_cos_i = log_one_minus(p.cos_i, p.one_minus_cos_i);
  p.log_one_minus_cos_r = log_one_minus(p.cos_r, p.one_minus_cos_r);
  p.s_z = p.cos_i + p.cos_r;
  // |s_h|² = (sin_i - sin_r)² + 2 sin_i sin_r (1 + cos delta), both parts as squares: no cancellation at the mirror.
  p.s_h2 = half_difference * square(cos_deg(0.5 * (ti + tr))) + 4.0 * sin_i * sin_r * square(cos_deg(0.5 * delta));
  // |L - V|² likewise, exact at the retro direction.
  const double difference2 = half_difference + 4.0 * sin_i * sin_r * square(sin_deg(0.5 * delta));
  p.cos_h = std::min(1.0, 0.5 * std::sqrt(p.s_h2 + square(p.s_z)));
  p.one_minus_cos_h = difference2 / (4.0 * (1.0 + p.cos_h));
  p.tan2_b = p.s_h2 / square(p.s_z);
  // The mirror of L has the same theta: its distance to V is |s_h|² and the difference of the two heights.
  const double height = 2.0 * sin_deg(0.5 * (ti + tr)) * sin_deg(0.5 * (tr - ti));  // cos_i - cos_r
  p.mirror_distance2 = p.s_h2 + square(height);
  p.forward = sin_r * cos_delta < 0.0;
  p.tan2_f = p.forward ? tan2_forward(sin_r, p.cos_r, cos_delta, sin_delta) : 0.0;
  // At L = N the swapped theta_f is 90°; fs vanishes there through (1 - cos_i), a finite tangent keeps 0 * infinity
  // out.
  p.tan2_f_swapped = p.forward && sin_i > 0.0 ? tan2_forward(sin_i, p.cos_i, cos_delta, sin_delta) : 0.0;
  return p;
}

PairBatch::PairBatch(const std::vector<AnglePair>& angles) {
  reserve(angles.size());
  for (const AnglePair& a : angles) push_back(make_pair(a));
}

void PairBatch::reserve(std::size_t n) {
  for (std::vector<double>* v :
       {&cos_i, &cos_r, &one_minus_cos_i, &one_minus_cos_r, &log_one_minus_cos_i, &log_one_minus_cos_r, &s_z, &s_h2,
        &cos_h, &one_minus_cos_h, &tan2_b, &mirror_distance2, &tan2_f, &tan2_f_swapped, &forward}) {
    v->reserve(n);
  }
}

void PairBatch::push_back(const Pair& p) {
  cos_i.push_back(p.cos_i);
  cos_r.push_back(p.cos_r);
  one_minus_cos_i.push_back(p.one_minus_cos_i);
  one_minus_cos_r.push_back(p.one_minus_cos_r);
  log_one_minus_cos_i.push_back(p.log_one_minus_cos_i);
  log_one_minus_cos_r.push_back(p.log_one_minus_cos_r);
  s_z.push_back(p.s_z);
  s_h2.push_back(p.s_h2);
  cos_h.push_back(p.cos_h);
  one_minus_cos_h.push_back(p.one_minus_cos_h);
  tan2_b.push_back(p.tan2_b);
  mirror_distance2.push_back(p.mirror_distance2);
  tan2_f.push_back(p.tan2_f);
  tan2_f_swapped.push_back(p.tan2_f_swapped);
  forward.push_back(p.forward ? 1.0 : 0.0);
}

PairBatch PairBatch::subset(const std::vector<std::size_t>& rows) const {
  PairBatch out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) out.push_back((*this)[row]);
  return out;
}

}  // namespace goniofit
