#include "support/albedo.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "geometry/angles.h"
#include "geometry/direction.h"

namespace goniofit::test {

namespace {

struct Node {
  double x, weight;
};

std::vector<Node> panel_nodes(const std::vector<double>& edges) {
  using Rule = boost::math::quadrature::gauss<double, 10>;
  std::vector<Node> nodes;
  for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    const double half = 0.5 * (edges[panel + 1] - edges[panel]);
    const double middle = 0.5 * (edges[panel + 1] + edges[panel]);
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const double offset = half * Rule::abscissa()[i];
      nodes.push_back({middle + offset, half * Rule::weights()[i]});
      nodes.push_back({middle - offset, half * Rule::weights()[i]});
    }
  }
  return nodes;
}

struct Widths {
  double x, y;
};

bool has_gaussian_lobe_alone(const Material& m) {
  return m.model == surface_model && m.components == EffectSet{Effect::dd} &&
         m.terms.distribution == DistributionTier::rough_limit;
}

// 0.3 ms a pair: the library's own 256 pairs are enough for what has no lobe.
bool is_integral_alone(const Material& m) {
  return m.model == surface_model && m.components == EffectSet{Effect::rough} && m.forms.rough == RoughForm::integral;
}

// Of the lobe in slopes; a peer's is anyone's guess, and panels start small enough for any of the tests'.
Widths widths_of(const Material& m) {
  if (m.model != surface_model) return {0.02, 0.02};
  const double slope = m.surface.slope.value_or(0.5);
  return {2.0 * slope, 2.0 * m.surface.slope_y.value_or(slope)};
}

// Panels of t double in width, from well inside the lobe (sigma_e narrows it towards grazing) to the end.
std::vector<double> slope_edges(double end) {
  std::vector<double> edges{0.0};
  for (double edge = 0.0625; edge < 0.7 * end; edge *= 2.0) edges.push_back(edge);
  edges.push_back(end);
  return edges;
}

// Seen from a grazing light, facets that face it crowd around its azimuth: panels close up there and opposite.
std::vector<double> azimuth_edges(double towards_light) {
  std::vector<double> edges;
  for (const double turn : {0.0, pi}) {
    for (const double offset : {0.0, 0.05, 0.25, 0.5 * pi, pi - 0.25, pi - 0.05}) {
      edges.push_back(towards_light + turn + offset);
    }
    if (turn == 0.0) continue;
    edges.push_back(towards_light + 2.0 * pi);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end(), [](double a, double b) { return b - a < 1e-9; }), edges.end());
  return edges;
}

// A mirror part is M/dOmega in the cone of dOmega and nothing else is: two solid angles tell M.
double mirror_part(const Evaluator& wide, const Evaluator& narrow, double theta_i_deg, double phi_i_deg) {
  const Pair p = make_pair({theta_i_deg, phi_i_deg, theta_i_deg, phi_i_deg + 180.0});
  const double difference = narrow.value(p, 0) - wide.value(p, 0);
  const double per_height = 1.0 / narrow.material().solid_angle_sr - 1.0 / wide.material().solid_angle_sr;
  return difference / per_height * p.cos_r;
}

}  // namespace

double directional_albedo(const Material& material, double theta_i_deg, double phi_i_deg) {
  if (is_integral_alone(material)) return hemispherical_reflectance(Evaluator(material), theta_i_deg).front();
  Material with_narrow_cone = material;
  with_narrow_cone.solid_angle_sr = 1e-20;  // no node comes into it
  const Evaluator evaluator(with_narrow_cone);
  const Direction l = direction_of(theta_i_deg, phi_i_deg);
  const Widths w = widths_of(material);
  const double furthest = has_gaussian_lobe_alone(material) ? 6.5 : HUGE_VAL;
  double sum = mirror_part(Evaluator(material), evaluator, theta_i_deg, phi_i_deg);
  for (const Node& psi : panel_nodes(azimuth_edges(std::atan2(l.y / w.y, l.x / w.x)))) {
    const double d_x = w.x * std::cos(psi.x);
    const double d_y = w.y * std::sin(psi.x);
    const double length2 = d_x * d_x + d_y * d_y;
    const double towards = l.x * d_x + l.y * d_y;
    const double root = std::sqrt(towards * towards + l.z * l.z * length2);
    // The positive root of l_z + 2 t towards - l_z length2 t² in the form without a cancellation.
    const double horizon = towards > 0.0 ? (towards + root) / (l.z * length2) : l.z / (root - towards);
    for (const Node& t : panel_nodes(slope_edges(std::min(horizon, furthest)))) {
      const double p = t.x * d_x;
      const double q = t.x * d_y;
      const double sec2 = 1.0 + p * p + q * q;
      const double along = l.x * p + l.y * q + l.z;  // u sec theta_b
      const Direction v{2.0 * along * p / sec2 - l.x, 2.0 * along * q / sec2 - l.y, 2.0 * along / sec2 - l.z};
      if (v.z <= 0.0) continue;
      // d omega_r = 4 u d omega_h, d omega_h = cos³ theta_b dp dq.
      const double measure = 4.0 * along / (sec2 * sec2) * w.x * w.y * t.x;
      sum += psi.weight * t.weight * measure * v.z * evaluator.value(make_pair(l, v), 0);
    }
  }
  return sum;
}

}  // namespace goniofit::test
