#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "brdf/evaluator.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

struct Node {
  double x, weight;
};

// Gauss-Legendre nodes on each of the panels between the given edges. An even number: no node of its own in the middle.
template <unsigned points = 20>
std::vector<Node> panel_nodes(const std::vector<double>& edge) {
  using Rule = boost::math::quadrature::gauss<double, points>;
  std::vector<Node> nodes;
  for (std::size_t panel = 0; panel + 1 < edge.size(); ++panel) {
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

// A Gaussian of slopes ends at 6.5 of its widths. A long tail, or light diffracted by a smooth surface, goes on to
// where facets stand upright.
std::vector<double> slope_panels(const Material& m) {
  const double scale = 2.0 * std::max(*m.surface.slope, m.surface.slope_y.value_or(0.0));
  std::vector<double> edges{0.0};
  for (const double width : {0.125, 0.5, 1.0, 2.0, 4.0, 6.5}) edges.push_back(scale * width);
  if (m.terms.distribution == DistributionTier::rough_limit) return edges;
  while (edges.back() < 300.0) edges.push_back(1.7 * edges.back());
  return edges;
}

// The lobe of an anisotropic surface is narrow in azimuth, where slopes of the larger width are.
std::vector<double> azimuth_panels(const Surface& s) {
  std::vector<double> edges{0.0, 0.25 * pi, 0.5 * pi};
  if (s.anisotropic()) {
    const double ratio = std::min(*s.slope, *s.slope_y) / std::max(*s.slope, *s.slope_y);
    const bool along_x = *s.slope > *s.slope_y;
    for (double width = 0.5; width > 0.3 * ratio; width *= 0.5) {
      edges.push_back(along_x ? 0.25 * pi * width : 0.5 * pi - 0.25 * pi * width);
    }
    std::sort(edges.begin(), edges.end());
  }
  const std::size_t half = edges.size();
  for (std::size_t i = half - 1; i-- > 0;) edges.push_back(pi - edges[i]);
  return edges;
}

struct Vector {
  double x, y, z;
};

AnglePair angles_of(double theta_i_deg, const Vector& v) noexcept {
  return {theta_i_deg, 0.0, degrees(std::atan2(std::hypot(v.x, v.y), v.z)), degrees(std::atan2(v.y, v.x))};
}

// f(pair, channel) over the slopes of the facets that mirror L into V: a lobe has the same width there at any
// incidence, however narrow it is as a function of V. d omega_r = 4 u d omega_h and d omega_h = cos³θ_b dp dq.
template <class F>
std::vector<double> over_facets(const Evaluator& e, double theta_i_deg, const std::vector<double>& slope_edges,
                                const std::vector<double>& azimuth_edges, const F& f) {
  std::vector<double> sum(e.channels(), 0.0);
  const Vector l{sin_deg(theta_i_deg), 0.0, cos_deg(theta_i_deg)};
  const std::vector<Node> azimuth = panel_nodes(azimuth_edges);
  for (const Node& slope : panel_nodes(slope_edges)) {
    const double cos_b = 1.0 / std::sqrt(1.0 + slope.x * slope.x);
    for (const Node& a : azimuth) {
      const Vector h{slope.x * cos_b * std::cos(a.x), slope.x * cos_b * std::sin(a.x), cos_b};
      const double u = l.x * h.x + l.z * h.z;
      const Vector v{2.0 * u * h.x - l.x, 2.0 * u * h.y, 2.0 * u * h.z - l.z};
      if (u <= 0.0 || v.z <= 0.0) continue;
      const Pair p = make_pair(angles_of(theta_i_deg, v));
      // Twice: the other half of the azimuths mirrors this one.
      const double measure = 2.0 * slope.weight * a.weight * slope.x * 4.0 * u * cos_b * cos_b * cos_b * p.cos_r;
      for (std::size_t c = 0; c < e.channels(); ++c) sum[c] += measure * f(p, c);
    }
  }
  return sum;
}

std::vector<double> dd_reflectance(const Evaluator& e, double theta_i_deg) {
  const Material& m = e.material();
  return over_facets(e, theta_i_deg, slope_panels(m), azimuth_panels(m.surface),
                     [&e](const Pair& p, std::size_t c) { return e.value(p, c, Effect::dd); });
}

// f(pair, channel) over directions by their cosine and their azimuth from the forward side.
template <class F>
std::vector<double> over_directions(const Evaluator& e, double theta_i_deg, const std::vector<Node>& cosines,
                                    const std::vector<Node>& azimuths, const F& f) {
  std::vector<double> sum(e.channels(), 0.0);
  for (const Node& cosine : cosines) {
    for (const Node& a : azimuths) {
      const Pair p = make_pair({theta_i_deg, 0.0, degrees(std::acos(cosine.x)), 180.0 - degrees(a.x)});
      const double measure = 2.0 * cosine.weight * a.weight * cosine.x;
      for (std::size_t c = 0; c < e.channels(); ++c) sum[c] += measure * f(p, c);
    }
  }
  return sum;
}

// What varies slowly; panels close up towards forward grazing, where fs is.
std::vector<double> smooth_reflectance(const Evaluator& e, double theta_i_deg) {
  return over_directions(e, theta_i_deg, panel_nodes({0.0, 0.02, 0.1, 0.4, 1.0}),
                         panel_nodes({0.0, 0.02, 0.1, 0.5, 0.5 * pi, pi}), [&e](const Pair& p, std::size_t c) {
                           return e.value(p, c, Effect::udf) + e.value(p, c, Effect::uds) + e.value(p, c, Effect::fs);
                         });
}

// Grooves have no lobe, and their integral takes its time.
std::vector<double> rough_reflectance(const Evaluator& e, double theta_i_deg) {
  return over_directions(e, theta_i_deg, panel_nodes<8>({0.0, 0.1, 1.0}), panel_nodes<8>({0.0, 0.5 * pi, pi}),
                         [&e](const Pair& p, std::size_t c) { return e.value(p, c, Effect::rough); });
}

// A peer has no effects to treat apart: panels that find a lobe about the mirror direction as narrow as its own, from
// the facets' point of view.
std::vector<double> peer_reflectance(const Evaluator& e, double theta_i_deg) {
  return over_facets(
      e, theta_i_deg, {0.0, 1e-4, 4e-4, 1.6e-3, 6.4e-3, 0.0256, 0.1, 0.2, 0.4, 0.8, 1.6, 4.0, 16.0, 300.0},
      {0.0, 0.25 * pi, 0.5 * pi, 0.75 * pi, pi}, [&e](const Pair& p, std::size_t c) { return e.value(p, c); });
}

// Over the cone about the mirror direction, in which nothing varies but slowly.
std::vector<double> coh_reflectance(const Evaluator& e, double theta_i_deg) {
  std::vector<double> sum(e.channels(), 0.0);
  const double sin_m = sin_deg(theta_i_deg);
  const double cos_m = cos_deg(theta_i_deg);
  const double edge = e.material().solid_angle_sr / (2.0 * pi);  // 1 - cos of its half angle
  for (const Node& depth : panel_nodes<8>({0.0, edge})) {
    const double sine = std::sqrt(depth.x * (2.0 - depth.x));
    for (const Node& a : panel_nodes<8>({0.0, 0.5 * pi, pi})) {
      const double across = sine * std::cos(a.x);
      const Vector v{across * cos_m - (1.0 - depth.x) * sin_m, sine * std::sin(a.x),
                     across * sin_m + (1.0 - depth.x) * cos_m};
      if (v.z <= 0.0) continue;
      const Pair p = make_pair(angles_of(theta_i_deg, v));
      const double measure = 2.0 * depth.weight * a.weight * p.cos_r;
      for (std::size_t c = 0; c < e.channels(); ++c) sum[c] += measure * e.value(p, c, Effect::coh);
    }
  }
  return sum;
}

}  // namespace

std::vector<double> hemispherical_reflectance(const Evaluator& evaluator, double theta_i_deg) {
  if (evaluator.material().model != surface_model) return peer_reflectance(evaluator, theta_i_deg);
  std::vector<double> sum = smooth_reflectance(evaluator, theta_i_deg);
  const auto add = [&sum](const std::vector<double>& part) {
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += part[c];
  };
  const Material& m = evaluator.material();
  if (m.components.has(Effect::dd) && m.surface.slope) add(dd_reflectance(evaluator, theta_i_deg));
  if (m.components.has(Effect::rough) && m.surface.facet_slope_deg) add(rough_reflectance(evaluator, theta_i_deg));
  if (m.components.has(Effect::coh) && m.surface.sigma_um) add(coh_reflectance(evaluator, theta_i_deg));
  return sum;
}

}  // namespace goniofit
