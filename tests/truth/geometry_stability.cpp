#include <cmath>
#include <limits>
#include <vector>

#include "stability.h"
#include "table_inputs.h"

namespace goniofit::stability {

namespace {

/// A part of a pair in either arithmetic, what its error is relative to (itself, or the sum it is a part of), and its
/// textbook form.
struct Part {
  const char* name;
  double Pair::*value;
  Big BasicPair<Big>::*wide;
  Big BasicPair<Big>::*scale;
  double (*naive)(const truth::naive::Sample&);
};

double naive_s_h2(const truth::naive::Sample& s) { return s.s.x * s.s.x + s.s.y * s.s.y; }
double naive_tan2_b(const truth::naive::Sample& s) {
  const double tangent = std::tan(s.theta_h);
  return tangent * tangent;
}
double naive_tan2_f(const truth::naive::Sample& s) {
  if (s.v.x * s.l.x + s.v.y * s.l.y > 0.0) return 0.0;
  const double tangent = std::tan(std::acos(-(s.v.x * s.l.x + s.v.y * s.l.y) / std::hypot(s.l.x, s.l.y)));
  return tangent * tangent;
}

#define GONIOFIT_PART(member, of) &Pair::member, &BasicPair<Big>::member, &BasicPair<Big>::of

const std::vector<Part>& parts() {
  using S = truth::naive::Sample;
  static const std::vector<Part> all{
      {"cos, V", GONIOFIT_PART(cos_r, cos_r), [](const S& s) { return s.v.z; }},
      {"1 - cos, V", GONIOFIT_PART(one_minus_cos_r, one_minus_cos_r), [](const S& s) { return 1.0 - s.v.z; }},
      {"ln(1 - cos), V", GONIOFIT_PART(log_one_minus_cos_r, log_one_minus_cos_r),
       [](const S& s) { return std::log(1.0 - s.v.z); }},
      {"s_z", GONIOFIT_PART(s_z, s_z), [](const S& s) { return s.s.z; }},
      {"s_x² + s_y²", GONIOFIT_PART(s_h2, s_h2), naive_s_h2},
      {"s_x² (of the sum)", GONIOFIT_PART(s_x2, s_h2), [](const S& s) { return s.s.x * s.s.x; }},
      {"s_y² (of the sum)", GONIOFIT_PART(s_y2, s_h2), [](const S& s) { return s.s.y * s.s.y; }},
      {"tan² θ_b", GONIOFIT_PART(tan2_b, tan2_b), naive_tan2_b},
      {"1 - H·V", GONIOFIT_PART(one_minus_cos_h, one_minus_cos_h), [](const S& s) { return 1.0 - s.u; }},
      {"tan² θ_f", GONIOFIT_PART(tan2_f, tan2_f), naive_tan2_f},
      {"distance² from the mirror", GONIOFIT_PART(mirror_distance2, mirror_distance2),
       [](const S& s) { return naive_s_h2(s) + (s.l.z - s.v.z) * (s.l.z - s.v.z); }},
  };
  return all;
}

#undef GONIOFIT_PART

double relative(double got, const Big& truth, const Big& scale) {
  if (std::isnan(got)) return got;
  if (std::isinf(got)) return std::numeric_limits<double>::infinity();
  if (scale == 0) return got == 0.0 ? 0.0 : 1.0;
  return static_cast<double>(Big(abs(got - truth) / abs(scale)));
}

void measure_parts(const test::TruthTable& table, std::size_t stride, Errors Line::*errors, std::vector<Line>& lines) {
  for (std::size_t row = 0; row < table.size(); row += stride) {
    const Inputs in = truth::inputs_of(table, row);
    const Pair pair = make_pair(truth::angles_of(in));
    const BasicPair<Big> wide = test::big_pair_of(truth::angles_of(in));
    const truth::naive::Sample naive{in};
    for (std::size_t i = 0; i < parts().size(); ++i) {
      const Part& part = parts()[i];
      (lines[i].*errors)
          .add(row, relative(pair.*part.value, wide.*part.wide, wide.*part.scale),
               relative(part.naive(naive), wide.*part.wide, wide.*part.scale));
    }
  }
}

}  // namespace

std::vector<Line> measure_geometry(const test::TruthTable& ordinary, const test::TruthTable& hard) {
  std::vector<Line> lines;
  for (const Part& part : parts()) lines.push_back({part.name, 1e-14, 1e-14, {}, {}});
  measure_parts(ordinary, 20, &Line::ordinary, lines);
  measure_parts(hard, 1, &Line::hard, lines);
  return lines;
}

}  // namespace goniofit::stability
