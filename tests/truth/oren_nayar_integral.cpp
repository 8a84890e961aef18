#include "oren_nayar_integral.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

namespace goniofit::truth {

namespace {

using Float = long double;
constexpr Float pi = std::numbers::pi_v<Float>;

/// Nodes and weights on (-1, 1): x = tanh(pi/2 sinh t), t = k 2^-level.
struct Rule {
  struct Node {
    Float x, weight;
  };
  std::vector<Node> nodes;

  explicit Rule(int level) {
    const Float h = std::ldexp(Float(1), -level);
    for (int k = -static_cast<int>(3.3L / h); k <= static_cast<int>(3.3L / h); ++k) {
      const Float t = static_cast<Float>(k) * h;
      const Float inner = pi / 2 * std::sinh(t);
      nodes.push_back({std::tanh(inner), h * pi / 2 * std::cosh(t) / (std::cosh(inner) * std::cosh(inner))});
    }
  }

  template <class F>
  [[nodiscard]] OrenNayarIntegral over(Float low, Float high, const F& f) const {
    const Float half = (high - low) / 2;
    OrenNayarIntegral sum;
    for (const Node& node : nodes) {
      const OrenNayarIntegral value = f((low + high) / 2 + half * node.x);
      sum.direct += half * node.weight * value.direct;
      sum.interreflection += half * node.weight * value.interreflection;
    }
    return sum;
  }
};

template <class F>
OrenNayarIntegral over_panels(const Rule& rule, std::vector<Float> ends, const F& f) {
  std::sort(ends.begin(), ends.end());
  OrenNayarIntegral sum;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i] - ends[i - 1] < 1e-15L) continue;
    const OrenNayarIntegral panel = rule.over(ends[i - 1], ends[i], f);
    sum.direct += panel.direct;
    sum.interreflection += panel.interreflection;
  }
  return sum;
}

struct Direction {
  Float theta, phi;
};

/// <w, a> for a facet at (theta_a, phi_a).
Float facing(const Direction& w, Float theta_a, Float phi_a) {
  return std::cos(theta_a) * std::cos(w.theta) + std::sin(theta_a) * std::sin(w.theta) * std::cos(phi_a - w.phi);
}

/// The part of a facet's width, from the groove, that the other facet of its cavity hides from w: (9)-(11) of the paper
/// with the width measured from the groove.
Float hidden_width(const Direction& w, Float facing_w, Float cos_a) {
  if (facing_w <= 0) return 1;
  return 1 - std::clamp(2 * std::cos(w.theta) * cos_a / facing_w, Float(0), Float(1));
}

/// f of the facets at (theta_a, phi_a): the projected radiance with (5) and the interreflection (11), over <s, n> E0.
OrenNayarIntegral facet_reflectance(const Direction& s, const Direction& v, Float theta_a, Float phi_a) {
  const Float cos_a = std::cos(theta_a);
  const Float sa = facing(s, theta_a, phi_a);
  const Float va = facing(v, theta_a, phi_a);
  OrenNayarIntegral f;
  if (va <= 0 || cos_a <= 0) return f;
  const Float ns = std::cos(s.theta);
  const Float nv = std::cos(v.theta);
  if (sa > 0) {
    // The attenuation (5), with min where the paper prints an inner Max.
    const Float gaf = std::min({Float(1), 2 * ns * cos_a / sa, 2 * nv * cos_a / va});
    f.direct = sa * va * gaf / (pi * cos_a * nv * ns);
  }
  const Float other = facing(s, theta_a, phi_a + pi);  // the opposite facet, which lights this one
  if (other > 0) {
    const Float mv = hidden_width(v, va, cos_a);
    const Float ms = hidden_width(s, other, cos_a);
    // sqrt(x² + 2xy cos(2 theta_a) + y²), as a sum of positive terms
    const auto r = [&](Float x, Float y) { return std::sqrt((x - y) * (x - y) + 4 * x * y * cos_a * cos_a); };
    const Float exchange = r(1, mv) + r(ms, 1) - r(ms, mv) - r(1, 1);
    f.interreflection = other * va / (cos_a * nv * ns) * exchange / (2 * pi);
  }
  return f;
}

/// Azimuths at which tan(theta_s) cos(phi - phi_s) = sign tan(theta_v) cos(phi - phi_v): where two bounds change roles.
std::vector<Float> equal_azimuths(const Direction& s, const Direction& v) {
  std::vector<Float> roots;
  for (const Float sign : {Float(1), Float(-1)}) {
    const Float c = std::tan(s.theta) * std::cos(s.phi) - sign * std::tan(v.theta) * std::cos(v.phi);
    const Float d = std::tan(s.theta) * std::sin(s.phi) - sign * std::tan(v.theta) * std::sin(v.phi);
    const Float root = std::atan2(-c, d);
    roots.push_back(root);
    roots.push_back(root + pi);
  }
  return roots;
}

void push_wrapped(std::vector<Float>& ends, Float phi) { ends.push_back(phi - 2 * pi * std::floor(phi / (2 * pi))); }

/// Ends of the panels in phi_a: besides equal_azimuths, where <w, a> or <w, a'> is 0 and where a bound
/// 2<w,n><a,n>/<w,a> reaches 1: both at cos(phi - phi_w) = +-cot(theta_a) cot(theta_w).
std::vector<Float> azimuth_ends(const Direction& s, const Direction& v, Float theta_a,
                                const std::vector<Float>& equal) {
  std::vector<Float> ends{0, 2 * pi};
  for (const Float phi : equal) push_wrapped(ends, phi);
  for (const Direction& w : {s, v}) {
    const Float k = 1 / (std::tan(theta_a) * std::tan(w.theta));
    if (!(k < 1)) continue;
    for (const Float c : {k, -k}) {
      push_wrapped(ends, w.phi + std::acos(c));
      push_wrapped(ends, w.phi - std::acos(c));
    }
  }
  return ends;
}

/// Ends of the panels in theta_a: where kinks in phi_a appear (theta_a = 90° - theta_w) or cross, and the bell's scale.
std::vector<Float> slope_ends(const Direction& s, const Direction& v, Float facet_slope,
                              const std::vector<Float>& equal) {
  std::vector<Float> ends{0, pi / 2};
  const auto push = [&](Float theta) {
    if (theta > 0 && theta < pi / 2) ends.push_back(theta);
  };
  push(pi / 2 - s.theta);
  push(pi / 2 - v.theta);
  for (const Float phi : equal) push(pi / 2 - std::atan(std::fabs(std::tan(s.theta) * std::cos(phi - s.phi))));
  for (const Float widths : {1.0L, 2.0L, 3.5L, 5.5L, 8.0L, 11.0L}) push(widths * facet_slope);
  return ends;
}

}  // namespace

OrenNayarIntegral oren_nayar_integral(double theta_i_deg, double theta_r_deg, double phi_deg, double facet_slope_deg,
                                      int level) {
  const Float degree = pi / 180;
  const Direction s{theta_i_deg * degree, 0};
  const Direction v{theta_r_deg * degree, phi_deg * degree};
  const Float sigma = facet_slope_deg * degree;
  const Rule rule(level);
  const std::vector<Float> equal = equal_azimuths(s, v);
  const std::vector<Float> ends = slope_ends(s, v, sigma, equal);

  const auto bell = [&](Float theta_a) {
    return std::exp(-theta_a * theta_a / (2 * sigma * sigma)) * std::sin(theta_a);
  };
  const auto ring = [&](Float theta_a) {
    const auto facet = [&](Float phi_a) { return facet_reflectance(s, v, theta_a, phi_a); };
    OrenNayarIntegral mean = over_panels(rule, azimuth_ends(s, v, theta_a, equal), facet);
    const Float weight = bell(theta_a) / (2 * pi);
    return OrenNayarIntegral{mean.direct * weight, mean.interreflection * weight};
  };
  const OrenNayarIntegral sum = over_panels(rule, ends, ring);
  const Float norm = over_panels(rule, ends, [&](Float theta_a) { return OrenNayarIntegral{bell(theta_a), 0}; }).direct;
  return {sum.direct / norm, sum.interreflection / norm};
}

}  // namespace goniofit::truth
