#include "brdf/sampling_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "geometry/angles.h"

namespace goniofit {

namespace {

double square(double x) noexcept { return x * x; }

// L in the space where both roughnesses are 1.
struct Stretched {
  Direction direction;
  double length;
};
Stretched stretched(const FacetLobe& lobe, const Direction& l) noexcept {
  const Direction s{lobe.alpha_x * l.x, lobe.alpha_y * l.y, l.z};
  const double length = std::sqrt(dot(s, s));
  return {{s.x / length, s.y / length, s.z / length}, length};
}

Direction reflected(const Direction& l, double slope_x, double slope_y) noexcept {
  const double cos_b = 1.0 / std::sqrt(1.0 + square(slope_x) + square(slope_y));
  const Direction h{slope_x * cos_b, slope_y * cos_b, cos_b};
  const double twice = 2.0 * dot(l, h);
  return {twice * h.x - l.x, twice * h.y - l.y, twice * h.z - l.z};
}

// Gaussian slopes seen at angle theta: the slope x towards the viewer has the density (cos + x sin) e^(-x²) where that
// is positive. With t = -x its integral below t, times 2, is cos sqrt(pi) (1 + erf t) + sin e^(-t²): a sum of positive
// terms, regular from the normal to grazing.
class VisibleGaussian {
 public:
  VisibleGaussian(double cos_theta, double sin_theta) noexcept
      : cos_(cos_theta),
        sin_(sin_theta),
        end_(sin_theta * farthest < cos_theta ? farthest : cos_theta / sin_theta),
        total_(integral(end_)) {}

  [[nodiscard]] double total() const noexcept { return total_; }

  // Minus the t with a share u below it: Halley's steps, halved where one leaves the bracket. (Where u nears 1 the
  // slope of the integral vanishes with the distance to the root, and steps only divide it.) What a step of 1e-7 leaves
  // is beyond the doubles.
  [[nodiscard]] double slope(double u) const noexcept {
    const double target = u * total_;
    double low = -farthest;
    double high = end_;
    double t = std::min(0.0, 0.5 * end_);
    for (int step = 0; step < 60; ++step) {
      const double gaussian = std::exp(-t * t);
      const double excess = cos_ * sqrt_pi * std::erfc(-t) + sin_ * gaussian - target;
      (excess > 0.0 ? high : low) = t;
      const double height = cos_ - t * sin_;
      const double newton = excess / (2.0 * height * gaussian);
      const double halley = t - newton / (1.0 + newton * (t + 0.5 * sin_ / height));
      const double next = halley > low && halley < high ? halley : 0.5 * (low + high);
      const double moved = std::fabs(next - t);
      t = next;
      if (moved < 1e-7) break;
    }
    return -t;
  }

 private:
  static constexpr double farthest = 6.0;  // e^(-36) = 2e-16: no double u asks for more
  [[nodiscard]] double integral(double t) const noexcept {
    return cos_ * sqrt_pi * std::erfc(-t) + sin_ * std::exp(-t * t);
  }

  static constexpr double sqrt_pi = 1.0 / std::numbers::inv_sqrtpi;
  double cos_, sin_, end_, total_;
};

// exp(-t²)/sqrt(pi), what is seen from above.
double normal_slope(double u) noexcept {
  constexpr double least = 1e-17;  // at u = 0 the slope is infinite
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return -boost::math::erfc_inv(2.0 * std::max(u, least), InDouble());
}

// A(L) = integral of D(H) max(0, L·H) over the facets.
double projected_area(const FacetLobe& lobe, const Stretched& l) noexcept {
  const double cos_theta = l.direction.z;
  if (lobe.slopes == FacetSlopes::long_tailed) return 0.5 * l.length * (1.0 + cos_theta);
  const double sin_theta = std::sqrt(square(l.direction.x) + square(l.direction.y));
  return 0.5 * std::numbers::inv_sqrtpi * l.length * VisibleGaussian(cos_theta, sin_theta).total();
}

struct Slopes {
  double x, y;
};

// Along and across the azimuth of the stretched L.
Slopes gaussian_slopes(const Direction& l, double u1, double u2) noexcept {
  const double sin_theta = std::sqrt(square(l.x) + square(l.y));
  const double along = VisibleGaussian(l.z, sin_theta).slope(u1);
  const double across = normal_slope(u2);
  const double cos_phi = sin_theta > 0.0 ? l.x / sin_theta : 1.0;
  const double sin_phi = sin_theta > 0.0 ? l.y / sin_theta : 0.0;
  return {along * cos_phi - across * sin_phi, along * sin_phi + across * cos_phi};
}

// The visible normals of a hemisphere are half vectors of L and a uniform direction in the cap z > -L_z (Dupuy &
// Benyoub 2023).
Slopes long_tailed_slopes(const Direction& l, double u1, double u2) noexcept {
  const double z = (1.0 - u1) * (1.0 + l.z) - l.z;
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double azimuth = 2.0 * pi * u2;
  const double hz = z + l.z;
  return {(radius * std::cos(azimuth) + l.x) / hz, (radius * std::sin(azimuth) + l.y) / hz};
}

// Towards the forward side of L; any azimuth will do at the normal.
struct Forward {
  double x, y;
};
Forward forward_of(const Direction& l) noexcept {
  const double sin_theta = std::sqrt(square(l.x) + square(l.y));
  return sin_theta > 0.0 ? Forward{-l.x / sin_theta, -l.y / sin_theta} : Forward{-1.0, 0.0};
}

}  // namespace

Direction CosineLobe::draw(double u1, double u2) noexcept {
  const double radius = std::sqrt(u1);
  const double azimuth = 2.0 * pi * u2;
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(1.0 - u1)};
}

double CosineLobe::density(const Direction& v) noexcept { return std::max(0.0, v.z) / pi; }

Direction ConeLobe::draw(const Direction& l, double u1, double u2) const noexcept {
  const double one_minus_cos = u1 * solid_angle_sr / (2.0 * pi);
  const double sin_cone = std::sqrt(one_minus_cos * (2.0 - one_minus_cos));
  const double a = sin_cone * std::cos(2.0 * pi * u2);
  const double b = sin_cone * std::sin(2.0 * pi * u2);
  // An orthonormal frame about the mirror direction without a branch (z > 0).
  const Direction m = mirrored(l);
  const double k = -1.0 / (1.0 + m.z);
  const double xy = m.x * m.y * k;
  const double c = 1.0 - one_minus_cos;
  return {a * (1.0 + m.x * m.x * k) + b * xy + c * m.x, a * xy + b * (1.0 + m.y * m.y * k) + c * m.y,
          -a * m.x - b * m.y + c * m.z};
}

double ConeLobe::density(const Direction& l, const Direction& v) const noexcept {
  const double distance2 = square(l.x + v.x) + square(l.y + v.y) + square(v.z - l.z);
  return distance2 <= solid_angle_sr / pi ? 1.0 / solid_angle_sr : 0.0;
}

Direction FacetLobe::draw(const Direction& l, double u1, double u2) const noexcept {
  const Direction s = stretched(*this, l).direction;
  const Slopes unit = slopes == FacetSlopes::gaussian ? gaussian_slopes(s, u1, u2) : long_tailed_slopes(s, u1, u2);
  return reflected(l, alpha_x * unit.x, alpha_y * unit.y);
}

double FacetLobe::density(const Direction& l, const Direction& v) const noexcept {
  const double s_z = l.z + v.z;
  const double slope_x = (l.x + v.x) / s_z;
  const double slope_y = (l.y + v.y) / s_z;
  const double steepness2 = square(slope_x / alpha_x) + square(slope_y / alpha_y);
  const double sec2 = 1.0 + square(slope_x) + square(slope_y);
  const double lobe = slopes == FacetSlopes::gaussian ? std::exp(-steepness2) : 1.0 / square(1.0 + steepness2);
  const double distribution = lobe * square(sec2) / (pi * alpha_x * alpha_y);
  return distribution / (4.0 * projected_area(*this, stretched(*this, l)));
}

Direction ForwardLobe::draw(const Direction& l, double u1, double u2) const noexcept {
  const double up = width * std::sqrt(-std::log1p(-u1));
  const double across = width * normal_slope(u2);
  const double along = 1.0 / std::sqrt(1.0 + square(up) + square(across));
  const Forward f = forward_of(l);
  return {along * (f.x - across * f.y), along * (f.y + across * f.x), along * up};
}

double ForwardLobe::density(const Direction& l, const Direction& v) const noexcept {
  const Forward f = forward_of(l);
  const double along = v.x * f.x + v.y * f.y;
  if (along <= 0.0 || v.z <= 0.0) return 0.0;
  const double up = v.z / (along * width);
  const double across = (v.y * f.x - v.x * f.y) / (along * width);
  const double slope_density = 2.0 * std::numbers::inv_sqrtpi * up * std::exp(-up * up - across * across);
  return slope_density / (square(width) * along * square(along));
}

}  // namespace goniofit
