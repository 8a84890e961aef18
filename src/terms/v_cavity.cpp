#include "terms/v_cavity.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "geometry/angles.h"
#include "terms/azimuth_difference.h"

namespace goniofit {

namespace {

double square(double x) noexcept { return x * x; }

// h - sin h cos h, h >= 0: by its series where the two terms cancel (the first left out is below 1e-17 relative).
double half_segment(double h) noexcept {
  if (h > 0.3) return h - std::sin(h) * std::cos(h);
  const double x2 = 4.0 * h * h;
  return h * x2 / 6.0 *
         (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0 * (1.0 - x2 / 156.0)))));
}

// One slope seen by one pair: A = 1 + p cos(phi), B = 1 + q cos(phi - delta).
struct Slope {
  const CavityView& view;
  double cos_a;
  double p, q;
};

// An arc of facet azimuths without a kink inside.
struct Arc {
  double centre, half;
  double sin_half;
  double p_cos, q_cos;  // p cos(phi), q cos(phi - delta) at the centre

  // The integral of (1 ± p cos)(1 + q cos), about the centre: narrow arcs with large p and q do not cancel.
  [[nodiscard]] double product(double sign, const Slope& s) const noexcept {
    const double a = sign * p_cos;
    return 2.0 * half + 2.0 * sin_half * (a + q_cos) + 2.0 * sin_half * std::cos(half) * a * q_cos +
           sign * s.p * s.q * s.view.cos_delta * half_segment(half);
  }
  // The integral of 1 + c cos, given c cos at the centre.
  [[nodiscard]] double single(double at_centre) const noexcept { return 2.0 * (half + sin_half * at_centre); }
};

double arc_direct(const Arc& arc, const Slope& s) noexcept {
  const double a = 1.0 + arc.p_cos;
  const double b = 1.0 + arc.q_cos;
  if (a <= 0.0 || b <= 0.0) return 0.0;
  if (std::max(a, b) <= 2.0) return arc.product(1.0, s);
  return 2.0 * arc.single(std::min(arc.p_cos, arc.q_cos));
}

// A' B times the interreflection factor, at one facet azimuth; A' and B > 0.
double interreflected(double cos_a, double other_a, double b) noexcept {
  const double lit = std::min(1.0, 2.0 / other_a);
  const double seen = std::min(1.0, 2.0 / b);
  return std::min(other_a, 2.0) * std::min(b, 2.0) * interreflection_density(cos_a, lit, seen);
}

// Distance in azimuth over which the integrand changes, at the end `phi` of an arc: that to the zeros of A', B and
// d(m_s,m_v), whichever are at work inside.
double layer(const Slope& s, double phi, bool partly_lit, bool partly_seen) noexcept {
  const double a = std::max(2.0, 1.0 - s.p * std::cos(phi));
  const double b = std::max(2.0, 1.0 + s.q * std::cos(phi - s.view.delta));
  const double a_rate = s.p * std::fabs(std::sin(phi));
  const double b_rate = s.q * std::fabs(std::sin(phi - s.view.delta));
  double distance = pi;
  if (partly_lit) distance = std::min(distance, a / std::max(a_rate, 1e-300));
  if (partly_seen) distance = std::min(distance, b / std::max(b_rate, 1e-300));
  if (partly_lit && partly_seen) {
    const double m_s = 1.0 - 2.0 / a;
    const double m_v = 1.0 - 2.0 / b;
    const double d = std::sqrt(square(m_s - m_v) + 4.0 * m_s * m_v * square(s.cos_a));
    const double rate = 2.0 * a_rate / square(a) + 2.0 * b_rate / square(b);
    distance = std::min(distance, d / std::max(rate, 1e-300));
  }
  return std::max(distance, 1e-9);
}

// From one end of an arc to its centre, in y = ln(1 + x/layer): what varies like 1/(layer + x) is smooth in y, with its
// nearest singularity at Im y = pi/2 or pi.
double half_arc_interreflection(const Slope& s, double end, double towards, double length, double width) noexcept {
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  constexpr double longest = 3.0;
  const double total = std::log1p(length / width);
  const int panels = std::max(1, static_cast<int>(std::ceil(total / longest)));
  const double step = 0.5 * total / panels;
  double sum = 0.0;
  for (int i = 0; i < panels; ++i) {
    const double middle = (2 * i + 1) * step;
    const auto at = [&](double y) {
      const double x = width * std::expm1(y);
      const double phi = end + towards * x;
      const double other_a = std::max(1e-300, 1.0 - s.p * std::cos(phi));
      const double b = std::max(1e-300, 1.0 + s.q * std::cos(phi - s.view.delta));
      return interreflected(s.cos_a, other_a, b) * (width + x);
    };
    for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k) {
      const double offset = step * Gauss::abscissa()[k];
      sum += step * Gauss::weights()[k] * (at(middle - offset) + at(middle + offset));
    }
  }
  return sum;
}

double arc_interreflection(const Arc& arc, const Slope& s) noexcept {
  const double other_a = 1.0 - arc.p_cos;
  const double b = 1.0 + arc.q_cos;
  if (other_a <= 0.0 || b <= 0.0) return 0.0;
  const bool partly_lit = other_a > 2.0;
  const bool partly_seen = b > 2.0;
  if (!partly_lit && !partly_seen) return (1.0 - s.cos_a) * arc.product(-1.0, s);
  const double first = arc.centre - arc.half;
  const double last = arc.centre + arc.half;
  return half_arc_interreflection(s, first, 1.0, arc.half, layer(s, first, partly_lit, partly_seen)) +
         half_arc_interreflection(s, last, -1.0, arc.half, layer(s, last, partly_lit, partly_seen));
}

// Sorted azimuths in [0, 2 pi) where a facet or its neighbour turns away (A, B = 0 or 2), and where shadowing and
// masking change roles (A = B, A' = B); the first is repeated a turn later.
struct Kinks {
  std::array<double, 13> phi;
  std::size_t size = 0;

  void add(double angle) noexcept {
    const double turn = 2.0 * pi;
    if (angle < 0.0) angle += turn;
    if (angle >= turn) angle -= turn;
    phi[size++] = angle;
  }
  void add_both(double angle) noexcept {  // and the opposite azimuth
    add(angle);
    add(angle + pi);
  }
  void close() noexcept {
    std::sort(phi.begin(), phi.begin() + static_cast<std::ptrdiff_t>(size));
    phi[size] = phi[0] + 2.0 * pi;
  }
};

Kinks find_kinks(const Slope& s) noexcept {
  Kinks kinks;
  const CavityView& v = s.view;
  if (s.p > 1.0) {
    const double angle = std::acos(1.0 / s.p);
    kinks.add_both(angle);
    kinks.add_both(-angle);
  }
  if (s.q > 1.0) {
    const double angle = std::acos(1.0 / s.q);
    kinks.add_both(v.delta + angle);
    kinks.add_both(v.delta - angle);
  }
  const double across = v.tan_r * v.sin_delta;
  kinks.add_both(std::atan2(v.tan_i - v.tan_r * v.cos_delta, across));
  kinks.add_both(std::atan2(v.tan_i + v.tan_r * v.cos_delta, -across));
  kinks.close();
  return kinks;
}

}  // namespace

CavityView make_cavity_view(const Pair& p) noexcept {
  const AzimuthDifference<double> azimuth = azimuth_difference(p);
  CavityView view{};
  view.tan_i = azimuth.sin_i / p.cos_i;
  view.tan_r = azimuth.sin_r / p.cos_r;
  view.cos_delta = azimuth.cos;
  view.sin_delta = azimuth.sin();
  view.delta = std::atan2(view.sin_delta, view.cos_delta);
  return view;
}

double geometric_attenuation(double a, double b) noexcept {
  return a > 0.0 && b > 0.0 ? std::min(1.0, 2.0 / std::max(a, b)) : 0.0;
}

double interreflection_density(double cos_a, double lit, double seen) noexcept {
  const double m_s = 1.0 - lit;
  const double m_v = 1.0 - seen;
  const double wide = 4.0 * cos_a * cos_a;  // 2 + 2 cos(2 theta_a)
  const double edges = 2.0 * cos_a;         // d(1,1)
  const double edge_seen = std::sqrt(seen * seen + wide * m_v);
  const double edge_lit = std::sqrt(lit * lit + wide * m_s);
  const double inner = std::sqrt(square(lit - seen) + wide * m_s * m_v);
  // d(1,y) - d(m_s,y) = (1-m_s) n(y)/(d(1,y) + d(m_s,y)), n(y) = 1 + m_s + 2y cos(2 theta_a): its difference between
  // y = m_v and y = 1, once more by differences of squares.
  const double n = wide - lit;
  const double outer_sum = edges + edge_lit;
  const double inner_sum = edge_seen + inner;
  const double rate = (wide - seen) / (edges + edge_seen) + (wide * m_s + 2.0 * lit - seen) / (edge_lit + inner);
  return 0.5 * (n * rate - (wide - 2.0) * outer_sum) / (outer_sum * inner_sum);
}

FacetReflectance uni_directional_facet(const Pair& pair, double theta_a, double phi_a) noexcept {
  if (pair.cos_i <= 0.0 || pair.cos_r <= 0.0) return {};
  const CavityView view = make_cavity_view(pair);
  const double cos_a = std::cos(theta_a);
  const double tan_a = std::tan(theta_a);
  const double a = 1.0 + tan_a * view.tan_i * std::cos(phi_a);
  const double b = 1.0 + tan_a * view.tan_r * std::cos(phi_a - view.delta);
  const double other_a = 2.0 - a;
  const double received = other_a > 0.0 && b > 0.0 ? interreflected(cos_a, other_a, b) : 0.0;
  return {cos_a * a * b * geometric_attenuation(a, b), cos_a * received};
}

CavityDeviation isotropic_deviation(const CavityView& view, double theta_a) noexcept {
  const double tan_a = std::tan(theta_a);
  const double cos_a = std::cos(theta_a);
  const double drop = 2.0 * square(std::sin(0.5 * theta_a));  // 1 - cos
  const Slope s{view, cos_a, tan_a * view.tan_i, tan_a * view.tan_r};
  if (s.p <= 1.0 && s.q <= 1.0) {  // every facet is lit and seen, whole
    const double tilt = 0.5 * cos_a * s.p * s.q * view.cos_delta;
    return {tilt - drop, drop * (cos_a - tilt)};
  }
  const Kinks kinks = find_kinks(s);
  double direct = 0.0;
  double interreflection = 0.0;
  for (std::size_t k = 0; k < kinks.size; ++k) {
    const double half = 0.5 * (kinks.phi[k + 1] - kinks.phi[k]);
    if (half <= 0.0) continue;
    const double centre = kinks.phi[k] + half;
    const Arc arc{centre, half, std::sin(half), s.p * std::cos(centre), s.q * std::cos(centre - view.delta)};
    direct += arc_direct(arc, s);
    interreflection += arc_interreflection(arc, s);
  }
  const double mean = cos_a / (2.0 * pi);
  return {direct * mean - 1.0, interreflection * mean};
}

FacetReflectance isotropic_single_slope(const Pair& pair, double theta_a) noexcept {
  if (pair.cos_i <= 0.0 || pair.cos_r <= 0.0) return {};
  const CavityDeviation deviation = isotropic_deviation(make_cavity_view(pair), theta_a);
  return {1.0 + deviation.direct_minus_one, deviation.interreflection};
}

}  // namespace goniofit
