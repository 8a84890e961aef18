#include "terms/v_cavity_integral.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "geometry/angles.h"

namespace goniofit {

namespace {

using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
using Gauss7 = boost::math::quadrature::gauss<double, 7>;

constexpr double steepest = 0.5 * pi;
constexpr double reach = 8.5;    // standard deviations: what lies beyond weighs e^-36
constexpr double flat = 1e-100;  // its square would underflow at 1e-150; the deviation from Lambert is 1e-200
constexpr std::size_t most_panels = 400;
constexpr double finest_tolerance = 1e-9;

double square(double x) noexcept { return x * x; }

double steepest_facet(double facet_slope) noexcept { return std::min(steepest, reach * facet_slope); }

// P(theta) sin(theta) and the mean of (theta/facet_slope)² under it.
class Density {
 public:
  explicit Density(double facet_slope) noexcept : facet_slope_(facet_slope) {
    using Gauss = boost::math::quadrature::gauss<double, 30>;
    const double end = steepest_facet(facet_slope);
    double second = 0.0;
    for (const double middle : {0.25, 0.75}) {  // 1e-15 relative in two panels
      for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k) {
        for (const double sign : {-1.0, 1.0}) {
          const double theta = end * (middle + sign * 0.25 * Gauss::abscissa()[k]);
          const double mass = 0.25 * end * Gauss::weights()[k] * unnormalised(theta);
          total_ += mass;
          second += mass * square(theta / facet_slope_);
        }
      }
    }
    mean_square_ = second / total_;
  }
  [[nodiscard]] double operator()(double theta) const noexcept { return unnormalised(theta) / total_; }
  // d ln P / d facet_slope
  [[nodiscard]] double log_derivative(double theta) const noexcept {
    return (square(theta / facet_slope_) - mean_square_) / facet_slope_;
  }

 private:
  [[nodiscard]] double unnormalised(double theta) const noexcept {
    return std::exp(-0.5 * square(theta / facet_slope_)) * std::sin(theta);
  }
  double facet_slope_;
  double total_ = 0.0;
  double mean_square_ = 0.0;
};

// direct - 1 and interreflection, then the derivative of each. Direct's deviation from 1 is what depends on facet_slope
// at all: small facet slopes keep their digits, in the derivative above all.
constexpr std::size_t values = 4;
using Values = std::array<double, values>;

struct Weighed {
  Values integral{}, error{}, scale{};
};

// The segment's variable u: theta = first + length u² (3 - 2u). Behind a split the integrand has terms in
// (theta - split)^(3/2), which are analytic in u.
CavityPanel sample(const CavityView& view, double first, double length, double from, double to) {
  CavityPanel panel{.from = from,
                    .to = to,
                    .first = first,
                    .length = length,
                    .theta = {},
                    .measure = {},
                    .direct_minus_one = {},
                    .interreflection = {}};
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  for (std::size_t i = 0; i < panel.theta.size(); ++i) {
    const std::size_t k = (i + 1) / 2;  // the centre, then both signs of each node
    const double node = Kronrod::abscissa()[k];
    const double u = middle + (i % 2 == 0 ? half * node : -half * node);
    panel.theta[i] = first + length * u * u * (3.0 - 2.0 * u);
    panel.measure[i] = half * length * 6.0 * u * (1.0 - u);
    const CavityDeviation deviation = isotropic_deviation(view, panel.theta[i]);
    panel.direct_minus_one[i] = deviation.direct_minus_one;
    panel.interreflection[i] = deviation.interreflection;
  }
  return panel;
}

// QUADPACK's error estimate: the 7 points of Gauss are much worse than the 15 they are among, by the power 3/2 of the
// difference over the integrand's variation.
Weighed weigh(const CavityPanel& panel, const Density& density) noexcept {
  std::array<Values, 15> integrand;
  Weighed sums;
  Values gauss{};
  for (std::size_t i = 0; i < integrand.size(); ++i) {
    const std::size_t k = (i + 1) / 2;
    const double weight = density(panel.theta[i]) * panel.measure[i];
    const double slope = density.log_derivative(panel.theta[i]);
    const double direct = weight * panel.direct_minus_one[i];
    const double interreflection = weight * panel.interreflection[i];
    integrand[i] = {direct, interreflection, direct * slope, interreflection * slope};
    for (std::size_t c = 0; c < values; ++c) {
      sums.integral[c] += Kronrod::weights()[k] * integrand[i][c];
      sums.scale[c] += Kronrod::weights()[k] * std::fabs(integrand[i][c]);
      if (k % 2 == 0) gauss[c] += Gauss7::weights()[k / 2] * integrand[i][c];
    }
  }
  for (std::size_t c = 0; c < values; ++c) {
    const double mean = 0.5 * sums.integral[c];
    double variation = 0.0;
    for (std::size_t i = 0; i < integrand.size(); ++i)
      variation += Kronrod::weights()[(i + 1) / 2] * std::fabs(integrand[i][c] - mean);
    const double difference = std::fabs(sums.integral[c] - gauss[c]);
    const double ratio = variation > 0.0 ? std::min(1.0, 200.0 * difference / variation) : 0.0;
    sums.error[c] = variation * ratio * std::sqrt(ratio);
  }
  return sums;
}

Weighed add_up(const std::vector<Weighed>& parts) noexcept {
  Weighed sums;
  for (const Weighed& part : parts) {
    for (std::size_t c = 0; c < values; ++c) {
      sums.integral[c] += part.integral[c];
      sums.error[c] += part.error[c];
      sums.scale[c] += part.scale[c];
    }
  }
  sums.scale[0] = std::fabs(1.0 + sums.integral[0]);
  return sums;
}

double relative(const Values& error, const Values& scale) noexcept {
  double worst = 0.0;
  for (std::size_t c = 0; c < values; ++c) {
    if (error[c] > 0.0) worst = std::max(worst, error[c] / std::max(scale[c], 1e-300));
  }
  return worst;
}

// The direct part of double forward grazing, where hardly a facet is lit and seen, is the round-off of its two terms
// and may be less than nothing.
VCavities result(const Weighed& sums) noexcept {
  return {std::max(0.0, 1.0 + sums.integral[0]), sums.integral[1], sums.integral[2], sums.integral[3],
          relative(sums.error, sums.scale)};
}

// Slope angles at which kinks in azimuth appear (a facet can turn away from L, from V) or change order (it can turn
// away from both at once; its neighbour from one while it does from the other), and where densities end.
std::vector<CavityPanel> first_panels(const CavityView& v, double first_end, double last_end) {
  const double across = v.tan_r * v.sin_delta;
  const double steep = v.tan_i * across;
  std::vector<double> at{0.0,
                         std::atan2(1.0, v.tan_i),
                         std::atan2(1.0, v.tan_r),
                         std::atan2(std::hypot(across, v.tan_r * v.cos_delta - v.tan_i), steep),
                         std::atan2(std::hypot(across, v.tan_r * v.cos_delta + v.tan_i), steep),
                         first_end,
                         last_end};
  for (double& angle : at) angle = std::min(angle, last_end);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::vector<CavityPanel> panels;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) panels.push_back(sample(v, at[k], at[k + 1] - at[k], 0.0, 1.0));
  return panels;
}

// Bisects the panel with the largest error until the density's integrals meet the tolerance.
Weighed refine(std::vector<CavityPanel>& panels, const CavityView& view, const Density& density, double tolerance) {
  std::vector<Weighed> parts;
  parts.reserve(panels.size());
  for (const CavityPanel& panel : panels) parts.push_back(weigh(panel, density));
  Weighed sums = add_up(parts);
  while (relative(sums.error, sums.scale) > tolerance && panels.size() < most_panels) {
    const auto worst = std::max_element(parts.begin(), parts.end(), [&](const Weighed& a, const Weighed& b) {
      return relative(a.error, sums.scale) < relative(b.error, sums.scale);
    });
    CavityPanel& lower = panels[static_cast<std::size_t>(worst - parts.begin())];
    const double middle = 0.5 * (lower.from + lower.to);
    const CavityPanel upper = sample(view, lower.first, lower.length, middle, lower.to);
    lower = sample(view, lower.first, lower.length, lower.from, middle);
    *worst = weigh(lower, density);
    parts.push_back(weigh(upper, density));
    panels.push_back(upper);
    sums = add_up(parts);
  }
  return sums;
}

bool outside_domain(const Pair& pair) noexcept { return pair.cos_i <= 0.0 || pair.cos_r <= 0.0; }

}  // namespace

VCavities gaussian_cavities(const Pair& pair, double facet_slope, double tolerance) {
  if (outside_domain(pair)) return {};
  if (facet_slope < flat) return {.direct = 1.0};
  const CavityView view = make_cavity_view(pair);
  const double end = steepest_facet(facet_slope);
  std::vector<CavityPanel> panels = first_panels(view, end, end);
  return result(refine(panels, view, Density(facet_slope), std::max(tolerance, finest_tolerance)));
}

VCavityTable::VCavityTable(const Pair& pair, double smallest_facet_slope, double largest_facet_slope, double tolerance)
    : pair_(pair),
      smallest_(std::max(smallest_facet_slope, flat)),
      largest_(largest_facet_slope),
      tolerance_(std::max(tolerance, finest_tolerance)) {
  if (outside_domain(pair)) return;
  const CavityView view = make_cavity_view(pair);
  panels_ = first_panels(view, steepest_facet(smallest_), steepest_facet(largest_));
  // Each density refines what the one before it left; an octave apart they leave no facet slope between them unserved.
  double slope = smallest_;
  while (slope < largest_) {
    refine(panels_, view, Density(slope), tolerance_);
    slope *= 2.0;
  }
  refine(panels_, view, Density(largest_), tolerance_);
}

VCavities VCavityTable::at(double facet_slope) const {
  if (outside_domain(pair_)) return {};
  if (facet_slope < smallest_ || facet_slope > largest_) return gaussian_cavities(pair_, facet_slope, tolerance_);
  const Density density(facet_slope);
  std::vector<Weighed> parts;
  parts.reserve(panels_.size());
  for (const CavityPanel& panel : panels_) parts.push_back(weigh(panel, density));
  return result(add_up(parts));
}

}  // namespace goniofit
