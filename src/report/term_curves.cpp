#include "report/term_curves.h"

#include <cmath>
#include <functional>
#include <utility>

#include "geometry/angles.h"
#include "geometry/pair.h"
#include "peers/rational_fraction.h"
#include "peers/schlick.h"
#include "support/error.h"
#include "support/text.h"
#include "terms/effective_roughness.h"
#include "terms/fresnel.h"
#include "terms/shadowing.h"
#include "terms/zenith.h"

namespace goniofit {

namespace {

using Row = std::function<std::vector<double>(double angle_deg)>;

TermCurves table(std::vector<std::string> columns, double last_deg, int steps, const Row& row) {
  TermCurves curves{.columns = std::move(columns), .rows = {}};
  for (int i = 0; i <= steps; ++i) {
    const double angle = last_deg * i / steps;
    std::vector<double> values{angle};
    for (const double v : row(angle)) values.push_back(v);
    curves.rows.push_back(std::move(values));
  }
  return curves;
}

// In plane, at the mirror direction: both cosines are alike.
Pair mirror_pair(double theta_deg) { return make_pair(in_plane(theta_deg, theta_deg)); }

TermCurves fresnel(const TermCurveSettings& s) {
  const double f0 = normal_reflectance(s.n, s.kappa);
  return table({"angle_deg", "exact", "schlick"}, 90.0, s.steps, [&, f0](double angle) {
    const double u = cos_deg(angle);
    return std::vector<double>{fresnel_exact(s.n, s.kappa, u, 1.0 - u), fresnel_schlick(f0, 1.0 - u)};
  });
}

// Schlick 1994 (18): g/(1 + g) with g = √(πh)(2 - erfc √h), h = cot²θ/(2 m²), m the RMS slope: √h is HT's cot θ/(2
// σ/τ).
double smith_as_printed_by_schlick(double slope, double c, double s) {
  const double root_h = c / (2.0 * slope * s);  // infinite at the normal
  const double g = std::sqrt(pi) * root_h * (2.0 - std::erfc(root_h));
  return 1.0 - 1.0 / (1.0 + g);
}

TermCurves shadowing(const TermCurveSettings& s) {
  return table({"theta_deg", "smith", "li-torrance", "schlick", "smith_as_printed_by_schlick"}, 90.0, s.steps,
               [&](double theta) {
                 if (theta == 90.0) return std::vector<double>{0.0, 0.0, 0.0, 0.0};
                 const Pair p = mirror_pair(theta);
                 const double c = p.cos_i;
                 const double sin = sine(c, p.one_minus_cos_i);
                 return std::vector<double>{c * shadowing_smith_over_cosine(s.slope, c, sin),
                                            shadowing_li_torrance(1.0 / s.slope, p.log_one_minus_cos_i),
                                            c * shadowing_schlick_over_cosine(s.slope, c),
                                            smith_as_printed_by_schlick(s.slope, c, sin)};
               });
}

TermCurves effective_roughness(const TermCurveSettings& s) {
  return table({"theta_deg", "he", "li-torrance"}, 90.0, s.steps, [&](double theta) {
    if (theta == 90.0) return std::vector<double>{0.0, 0.0};
    const Pair p = mirror_pair(theta);
    return std::vector<double>{std::exp(log_effective_roughness_he(s.slope, p)),
                               std::exp(2.0 * log_visible_part(1.0 / s.slope, p.log_one_minus_cos_i))};
  });
}

TermCurves slopes(const TermCurveSettings& s) {
  const double m = 2.0 * s.slope;
  if (m > 1.0) throw usage_error("slope " + shortest(s.slope) + ": expected at most 0.5 for slopes");
  const SchlickSlopes schlick(m);
  return table({"theta_deg", "beckmann", "schlick"}, 90.0, s.steps, [&](double theta) {
    const double t = cos_deg(theta);
    const double t2 = t * t;
    const double beckmann = t > 0.0 ? std::exp((t2 - 1.0) / (m * m * t2)) / (m * m * t2 * t2) : 0.0;
    return std::vector<double>{beckmann, schlick(t)};
  });
}

TermCurves azimuth(const TermCurveSettings& s) {
  return table({"azimuth_deg", "normalised", "printed"}, 360.0, 4 * s.steps, [&](double phi) {
    // H at 45°: A reads nothing but its azimuth.
    const Pair p = make_pair(AnglePair{.theta_i_deg = 45.0, .phi_i_deg = phi, .theta_r_deg = 45.0, .phi_r_deg = phi});
    return std::vector<double>{schlick_azimuth<SchlickAzimuth::normalised>(s.p, p),
                               schlick_azimuth<SchlickAzimuth::printed>(s.p, p)};
  });
}

void check(const TermCurveSettings& s) {
  const auto expect = [](bool good, const char* name, double value, const char* range) {
    if (!good) throw usage_error(std::string(name) + ' ' + shortest(value) + ": expected " + range);
  };
  expect(s.slope >= 1e-4 && s.slope <= 10.0, "slope", s.slope, "0.0001 to 10");
  expect(s.n > 0.0 && s.n <= 100.0, "n", s.n, "above 0, at most 100");
  expect(s.kappa >= 0.0 && s.kappa <= 1e6, "kappa", s.kappa, "0 to 1e6");
  expect(s.p > 0.0 && s.p <= 1.0, "p", s.p, "above 0, at most 1");
  expect(s.steps >= 1 && s.steps <= 100000, "steps", s.steps, "1 to 100000");
}

}  // namespace

TermCurves term_curves(std::string_view term, const TermCurveSettings& settings) {
  check(settings);
  constexpr std::pair<std::string_view, TermCurves (*)(const TermCurveSettings&)> makers[] = {
      {"fresnel", fresnel},
      {"shadowing", shadowing},
      {"effective_roughness", effective_roughness},
      {"slopes", slopes},
      {"azimuth", azimuth}};
  for (const auto& [name, make] : makers) {
    if (name == term) return make(settings);
  }
  throw usage_error(in_quotes(term) + ": expected " + std::string(term_curve_names));
}

}  // namespace goniofit
