#include "side_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "he_torrance_sum.h"
#include "oren_nayar_integral.h"

namespace goniofit::truth {

namespace {

constexpr int integral_level = 4;

double relative_difference(const OrenNayarIntegral& a, const OrenNayarIntegral& b) {
  const auto one = [](long double x, long double y) { return std::fabs(x - y) / std::fmax(std::fabs(y), 1e-30L); };
  return static_cast<double>(std::max(one(a.direct, b.direct), one(a.interreflection, b.interreflection)));
}

std::string printed(const char* format, long double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

}  // namespace

std::string lobe_header() { return "g,x,ln_W,dln_W_dln_g,dln_W_dln_x"; }

std::string lobe_line(const LobeInputs& inputs) {
  const Real g(inputs.g);
  const Real x(inputs.x);
  const LobeSum<Real> sum = he_torrance_sum(g, x);
  return joined({shortest(inputs.g), shortest(inputs.x), text(sum.log_w, hard_digits),
                 text(Real(sum.dlog_dg * g), hard_digits), text(Real(sum.dlog_dx * x), hard_digits)});
}

std::vector<IntegralInputs> integral_inputs() {
  std::vector<IntegralInputs> rows;
  for (const double facet_slope : {5.0, 15.0, 30.0, 45.0}) {
    for (const double theta_i : {10.0, 45.0, 75.0}) {
      rows.push_back({theta_i, 5, 60, facet_slope});
      rows.push_back({theta_i, 40, 0, facet_slope});
      rows.push_back({theta_i, 40, 180, facet_slope});
      rows.push_back({theta_i, 70, 110, facet_slope});
      rows.push_back({theta_i, 85, 160, facet_slope});
    }
    rows.push_back({0, 50, 0, facet_slope});
    rows.push_back({60, 60, 180, facet_slope});
  }
  return rows;
}

std::string integral_header() { return "theta_i,theta_r,delta_phi,facet_slope_deg,direct,interreflection,error"; }

std::string integral_line(const IntegralInputs& a) {
  const auto at = [&](int level) {
    return oren_nayar_integral(a.theta_i, a.theta_r, a.delta_phi, a.facet_slope_deg, level);
  };
  const OrenNayarIntegral value = at(integral_level);
  return joined({shortest(a.theta_i), shortest(a.theta_r), shortest(a.delta_phi), shortest(a.facet_slope_deg),
                 printed("%.13Lg", value.direct), printed("%.13Lg", value.interreflection),
                 printed("%.1Le", relative_difference(at(integral_level - 1), value))});
}

}  // namespace goniofit::truth
