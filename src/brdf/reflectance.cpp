#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "brdf/evaluator.h"
#include "brdf/optics.h"
#include "brdf/shape_kernels.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

struct Node {
  double x, weight;
};

// Gauss-Legendre nodes on each of the panels between the given edges.
template <std::size_t edges>
std::vector<Node> panel_nodes(const std::array<double, edges>& edge) {
  using Rule = boost::math::quadrature::gauss<double, 20>;
  std::vector<Node> nodes;
  for (std::size_t panel = 0; panel + 1 < edges; ++panel) {
    const double half = 0.5 * (edge[panel + 1] - edge[panel]);
    const double middle = 0.5 * (edge[panel + 1] + edge[panel]);
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const double offset = half * Rule::abscissa()[i];
      const double weight = half * Rule::weights()[i];
      nodes.push_back({middle + offset, weight});
      nodes.push_back({middle - offset, weight});
    }
  }
  return nodes;
}

struct Vector {
  double x, y, z;
};

AnglePair angles_of(double theta_i_deg, const Vector& v) noexcept {
  return {theta_i_deg, 0.0, degrees(std::atan2(std::hypot(v.x, v.y), v.z)), degrees(std::atan2(v.y, v.x))};
}

// dd over the slopes of the facets that mirror L into V: the lobe has the same width there at any incidence, however
// narrow it is as a function of V. d omega_r = 4 u d omega_h and d omega_h = cos³θ_b dp dq.
std::vector<double> dd_reflectance(const Evaluator& e, double theta_i_deg) {
  std::vector<double> sum(e.channels(), 0.0);
  const double scale = 2.0 * *e.material().surface.slope;
  const Vector l{sin_deg(theta_i_deg), 0.0, cos_deg(theta_i_deg)};
  const std::vector<Node> radial = panel_nodes<7>({0.0, 0.125, 0.5, 1.0, 2.0, 4.0, 6.5});
  const std::vector<Node> azimuth = panel_nodes<5>({0.0, 0.25 * pi, 0.5 * pi, 0.75 * pi, pi});
  for (const Node& t : radial) {
    const double slope = scale * t.x;
    const double cos_b = 1.0 / std::sqrt(1.0 + slope * slope);
    for (const Node& a : azimuth) {
      const Vector h{slope * cos_b * std::cos(a.x), slope * cos_b * std::sin(a.x), cos_b};
      const double u = l.x * h.x + l.z * h.z;
      const Vector v{2.0 * u * h.x - l.x, 2.0 * u * h.y, 2.0 * u * h.z - l.z};
      if (u <= 0.0 || v.z <= 0.0) continue;
      const Pair p = make_pair(angles_of(theta_i_deg, v));
      // Twice: the other half of the azimuths mirrors this one.
      const double measure = 2.0 * t.weight * a.weight * scale * slope * 4.0 * u * cos_b * cos_b * cos_b * p.cos_r;
      for (std::size_t c = 0; c < e.channels(); ++c) sum[c] += measure * e.value(p, c, Effect::dd);
    }
  }
  return sum;
}

// What varies slowly, over directions; panels close up towards forward grazing, where fs is.
std::vector<double> smooth_reflectance(const Evaluator& e, double theta_i_deg) {
  std::vector<double> sum(e.channels(), 0.0);
  const std::vector<Node> cosines = panel_nodes<5>({0.0, 0.02, 0.1, 0.4, 1.0});
  const std::vector<Node> azimuths = panel_nodes<6>({0.0, 0.02, 0.1, 0.5, 0.5 * pi, pi});  // from the forward side
  for (const Node& cosine : cosines) {
    for (const Node& a : azimuths) {
      const Pair p = make_pair({theta_i_deg, 0.0, degrees(std::acos(cosine.x)), 180.0 - degrees(a.x)});
      const double measure = 2.0 * cosine.weight * a.weight * cosine.x;
      for (std::size_t c = 0; c < e.channels(); ++c) {
        for (const Effect effect : {Effect::udf, Effect::uds, Effect::fs}) sum[c] += measure * e.value(p, c, effect);
      }
    }
  }
  return sum;
}

// The cone's energy: value in its middle times cos_r times its solid angle (cos_r averages to cos_i over the cone).
std::vector<double> coh_reflectance(const Evaluator& e, double theta_i_deg) {
  std::vector<double> sum;
  const Pair p = make_pair(in_plane(theta_i_deg, theta_i_deg));
  for (std::size_t c = 0; c < e.channels(); ++c) {
    sum.push_back(e.value(p, c, Effect::coh) * p.cos_i * e.material().solid_angle_sr);
  }
  return sum;
}

}  // namespace

std::vector<double> hemispherical_reflectance(const Evaluator& evaluator, double theta_i_deg) {
  std::vector<double> sum = smooth_reflectance(evaluator, theta_i_deg);
  const auto add = [&sum](const std::vector<double>& part) {
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += part[c];
  };
  const Material& m = evaluator.material();
  if (m.components.has(Effect::dd) && m.surface.slope) add(dd_reflectance(evaluator, theta_i_deg));
  if (m.components.has(Effect::coh) && m.surface.sigma_um) add(coh_reflectance(evaluator, theta_i_deg));
  return sum;
}

}  // namespace goniofit
