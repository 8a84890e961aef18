#include "geometry/pair.h"

#include <algorithm>
#include <array>
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

// phi_r - phi_i in degrees, wrapped, and what rounding the difference of two large azimuths took off it: 1e-14° is
// 1e-12 of a lobe of slope 1e-3.
struct AzimuthStep {
  double delta, rest;
};
AzimuthStep azimuth_step(double phi_i, double phi_r) noexcept {
  const double difference = phi_r - phi_i;
  const double less = difference - phi_r;
  return {wrap_deg(difference), (phi_r - (difference - less)) - (phi_i + less)};
}

// cos ½(a + b). Where both are near 90° their sum has rounded away what the cosine is made of, and 90 - a has not.
double cos_half_sum(double a, double b) noexcept {
  return a + b > 90.0 ? sin_deg(0.5 * ((90.0 - a) + (90.0 - b))) : cos_deg(0.5 * (a + b));
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
  const auto [delta, rest] = azimuth_step(a.phi_i_deg, a.phi_r_deg);
  const double turn = radians(rest);  // to first order from here on
  const double sin_i = sin_deg(ti);
  const double sin_r = sin_deg(tr);
  const double rounded_cos_delta = cos_deg(delta);
  const double rounded_sin_delta = sin_deg(delta);
  const double cos_delta = rounded_cos_delta - turn * rounded_sin_delta;
  const double sin_delta = rounded_sin_delta + turn * rounded_cos_delta;
  const double rounded_cos_half = cos_deg(0.5 * delta);
  const double rounded_sin_half = sin_deg(0.5 * delta);
  const double cos_half = rounded_cos_half - 0.5 * turn * rounded_sin_half;
  const double sin_half = rounded_sin_half + 0.5 * turn * rounded_cos_half;
  const double cos_mean = cos_half_sum(ti, tr);
  const double sin_half_difference = sin_deg(0.5 * (ti - tr));
  const double half_difference = square(2.0 * sin_half_difference);  // 4 sin²

  Pair p{};
  p.cos_i = cos_deg(ti);
  p.cos_r = cos_deg(tr);
  p.one_minus_cos_i = 2.0 * square(sin_deg(0.5 * ti));
  p.one_minus_cos_r = 2.0 * square(sin_deg(0.5 * tr));
  p.log_one_minus_cos_i = log_one_minus(p.cos_i, p.one_minus_cos_i);
  p.log_one_minus_cos_r = log_one_minus(p.cos_r, p.one_minus_cos_r);
  p.s_z = p.cos_i + p.cos_r;
  // |s_h|² = (sin_i - sin_r)² + 2 sin_i sin_r (1 + cos delta), both parts as squares: no cancellation at the mirror.
  p.s_h2 = half_difference * square(cos_mean) + 4.0 * sin_i * sin_r * square(cos_half);
  // |L - V|² likewise, exact at the retro direction.
  const double difference2 = half_difference + 4.0 * sin_i * sin_r * square(sin_half);
  p.cos_h = std::min(1.0, 0.5 * std::sqrt(p.s_h2 + square(p.s_z)));
  p.one_minus_cos_h = difference2 / (4.0 * (1.0 + p.cos_h));
  p.tan2_b = p.s_h2 / square(p.s_z);
  // The mirror of L has the same theta: its distance to V is |s_h|² and the difference of the two heights.
  const double height = -2.0 * sin_deg(0.5 * (ti + tr)) * sin_half_difference;  // cos_i - cos_r
  p.mirror_distance2 = p.s_h2 + square(height);
  p.forward = sin_r * cos_delta < 0.0;
  p.tan2_f = p.forward ? tan2_forward(sin_r, p.cos_r, cos_delta, sin_delta) : 0.0;
  // At L = N the swapped theta_f is 90°; fs vanishes there through (1 - cos_i), a finite tangent keeps 0 * infinity
  // out.
  p.tan2_f_swapped = p.forward && sin_i > 0.0 ? tan2_forward(sin_i, p.cos_i, cos_delta, sin_delta) : 0.0;
  p.dot_h = sin_i * sin_r * cos_delta;
  // s_h along the azimuth of L and across it: sin_i + sin_r cos delta with the mirror side's cancellation taken out.
  const double along = cos_delta < 0.0 ? 2.0 * sin_half_difference * cos_mean + 2.0 * sin_r * square(cos_half)
                                       : sin_i + sin_r * cos_delta;
  const double across = sin_r * sin_delta;
  const double cos_phi = cos_deg(a.phi_i_deg);
  const double sin_phi = sin_deg(a.phi_i_deg);
  p.s_x2 = square(along * cos_phi - across * sin_phi);
  p.s_y2 = square(along * sin_phi + across * cos_phi);
  p.cos2_phi_i = square(cos_phi);
  p.sin2_phi_i = square(sin_phi);
  p.cos2_phi_r = square(cos_deg(a.phi_r_deg));
  p.sin2_phi_r = square(sin_deg(a.phi_r_deg));
  return p;
}

namespace {

// An array of the batch and what a pair has for it.
template <class Real>
struct Field {
  std::vector<Real> BasicPairBatch<Real>::*array;
  double Pair::*member;
};

template <class Real>
constexpr std::array fields{
    Field<Real>{&BasicPairBatch<Real>::cos_i, &Pair::cos_i},
    Field<Real>{&BasicPairBatch<Real>::cos_r, &Pair::cos_r},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_i, &Pair::one_minus_cos_i},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_r, &Pair::one_minus_cos_r},
    Field<Real>{&BasicPairBatch<Real>::log_one_minus_cos_i, &Pair::log_one_minus_cos_i},
    Field<Real>{&BasicPairBatch<Real>::log_one_minus_cos_r, &Pair::log_one_minus_cos_r},
    Field<Real>{&BasicPairBatch<Real>::s_z, &Pair::s_z},
    Field<Real>{&BasicPairBatch<Real>::s_h2, &Pair::s_h2},
    Field<Real>{&BasicPairBatch<Real>::cos_h, &Pair::cos_h},
    Field<Real>{&BasicPairBatch<Real>::one_minus_cos_h, &Pair::one_minus_cos_h},
    Field<Real>{&BasicPairBatch<Real>::tan2_b, &Pair::tan2_b},
    Field<Real>{&BasicPairBatch<Real>::mirror_distance2, &Pair::mirror_distance2},
    Field<Real>{&BasicPairBatch<Real>::tan2_f, &Pair::tan2_f},
    Field<Real>{&BasicPairBatch<Real>::tan2_f_swapped, &Pair::tan2_f_swapped},
    Field<Real>{&BasicPairBatch<Real>::dot_h, &Pair::dot_h},
    Field<Real>{&BasicPairBatch<Real>::s_x2, &Pair::s_x2},
    Field<Real>{&BasicPairBatch<Real>::s_y2, &Pair::s_y2},
    Field<Real>{&BasicPairBatch<Real>::cos2_phi_i, &Pair::cos2_phi_i},
    Field<Real>{&BasicPairBatch<Real>::sin2_phi_i, &Pair::sin2_phi_i},
    Field<Real>{&BasicPairBatch<Real>::cos2_phi_r, &Pair::cos2_phi_r},
    Field<Real>{&BasicPairBatch<Real>::sin2_phi_r, &Pair::sin2_phi_r},
};

}  // namespace

template <class Real>
BasicPairBatch<Real>::BasicPairBatch(const std::vector<AnglePair>& angles) {
  reserve(angles.size());
  for (const AnglePair& a : angles) push_back(make_pair(a));
}

template <class Real>
template <class Other>
BasicPairBatch<Real>::BasicPairBatch(const BasicPairBatch<Other>& other) {
  reserve(other.size());
  for (std::size_t i = 0; i < other.size(); ++i) push_back(other.template as<double>(i));
}

template <class Real>
void BasicPairBatch<Real>::reserve(std::size_t n) {
  for (const Field<Real>& f : fields<Real>) (this->*f.array).reserve(n);
  forward.reserve(n);
}

template <class Real>
void BasicPairBatch<Real>::push_back(const Pair& p) {
  for (const Field<Real>& f : fields<Real>) (this->*f.array).push_back(static_cast<Real>(p.*f.member));
  forward.push_back(p.forward ? Real(1) : Real(0));
}

template <class Real>
BasicPairBatch<Real> BasicPairBatch<Real>::subset(const std::vector<std::size_t>& rows) const {
  BasicPairBatch out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) out.push_back(as<double>(row));
  return out;
}

template class BasicPairBatch<double>;
template class BasicPairBatch<float>;
template BasicPairBatch<float>::BasicPairBatch(const BasicPairBatch<double>&);
template BasicPairBatch<double>::BasicPairBatch(const BasicPairBatch<float>&);

}  // namespace goniofit
