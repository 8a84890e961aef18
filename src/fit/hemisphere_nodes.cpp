#include "fit/hemisphere_nodes.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>

#include "geometry/angles.h"
#include "geometry/direction.h"

namespace goniofit {

namespace {

struct Node {
  double x, weight;
};

template <unsigned points>
void add_panel(double low, double high, std::vector<Node>& nodes) {
  using Rule = boost::math::quadrature::gauss<double, points>;  // points is even: no abscissa of 0
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      nodes.push_back(
          {0.5 * (low + high + side * (high - low) * Rule::abscissa()[i]), 0.5 * (high - low) * Rule::weights()[i]});
    }
  }
}

// Radii from 0 to `most`, evenly in ln(1 + radius / finest), with an edge at `edge` where it lies between.
std::vector<Node> radii(double most, double edge) {
  constexpr double finest = 1e-4;
  const auto log_of = [](double radius) { return std::log1p(radius / finest); };
  std::vector<Node> nodes;
  if (edge > 0.0 && edge < most) {
    add_panel<24>(0.0, log_of(edge), nodes);
    add_panel<24>(log_of(edge), log_of(most), nodes);
  } else {
    add_panel<48>(0.0, log_of(most), nodes);
  }
  for (Node& node : nodes) {
    node.weight *= finest * std::exp(node.x);
    node.x = finest * std::expm1(node.x);
  }
  return nodes;
}

// Azimuths about the mirror direction; 0 points to the horizon. Panels close up where the circles begin to be cut by
// it.
std::vector<Node> azimuths() {
  std::vector<Node> nodes;
  constexpr std::array edges{0.0, 0.3, 0.45, 0.5, 0.55, 0.7, 1.0};
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) add_panel<8>(edges[i] * pi, edges[i + 1] * pi, nodes);
  return nodes;
}

}  // namespace

HemisphereNodes hemisphere_nodes(double theta_i_deg, double mirror_cone_sr, bool both_sides) {
  const double sin_i = sin_deg(theta_i_deg);
  const double cos_i = cos_deg(theta_i_deg);
  const Direction l{sin_i, 0.0, cos_i};
  const double cone = 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(mirror_cone_sr / pi)));
  HemisphereNodes out;
  for (const Node& azimuth : azimuths()) {
    const double along = std::cos(azimuth.x);
    const double across = std::sin(azimuth.x);
    const double horizon = std::atan2(cos_i, sin_i * along);
    for (const Node& radius : radii(horizon, cone)) {
      const double s = std::sin(radius.x);
      const double c = std::cos(radius.x);
      // The mirror direction (-sin, 0, cos), its tangents towards the horizon (-cos, 0, -sin) and across (0, 1, 0).
      const Direction v{-c * sin_i - s * along * cos_i, s * across, c * cos_i - s * along * sin_i};
      if (v.z <= 0.0) continue;
      const double weight = azimuth.weight * radius.weight * s * v.z;
      for (const double side : {1.0, -1.0}) {
        if (side < 0.0 && !both_sides) break;
        out.pairs.push_back(make_pair(l, Direction{v.x, side * v.y, v.z}));
        out.weight.push_back(both_sides ? weight : 2.0 * weight);
      }
    }
  }
  return out;
}

}  // namespace goniofit
