// The formulas themselves, without a double's rounding: the program's templates on 50-digit floats, from 50-digit
// pairs, against the tables to all of their digits and, for every combination of tiers, against the plain definitions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "combinations.h"
#include "models.h"
#include "oren_nayar_definitions.h"
#include "quantities.h"

namespace goniofit::stability {
namespace {

using test::TruthTable;
using truth::Hundred;

constexpr double beyond_doubles = 1.7976931348623157e308;

/// Error in units of the table's last digit, of numbers with `digits` of them.
double digits_off(const Quantity& q, const Outcome<Big>& f, const std::string& cell, int digits) {
  if (cell == "inf" || cell == "-inf") {
    const bool none = f.value == 0 && q.kind == Kind::log_of_value;
    const Big least = cell == "inf" ? -f.log : f.log;
    return none || least < -beyond_doubles ? 0.0 : HUGE_VAL;
  }
  const Big truth(cell);
  const Big got = q.kind == Kind::plain ? f.value : f.log;
  const Big unit = pow(Big(10), 1 - digits);
  if (abs(truth) > beyond_doubles) return got < -beyond_doubles ? 0.0 : HUGE_VAL;
  if (truth == 0) return abs(got) < 1e-300 ? 0.0 : HUGE_VAL;
  return static_cast<double>(Big(abs(got - truth) / (unit * abs(truth))));
}

bool sums_for_seconds(const Quantity& q, const Inputs& in) {
  const bool sums = q.name.find("series") != std::string_view::npos;
  return sums && in.sigma_um > 2.0 * in.wavelength_um;
}

void expect_all_digits(const TruthTable& table, int digits, std::size_t stride) {
  std::size_t cells = 0;
  double worst = 0.0;
  for (std::size_t row = 0; row < table.size(); row += stride) {
    const Inputs in = truth::inputs_of(table, row);
    const Sample<Big> sample = sample_of<Big>(in, test::big_pair_of(truth::angles_of(in)));
    for (const Quantity& q : quantities()) {
      if (q.in_big == nullptr || !table.has(q.column) || sums_for_seconds(q, in)) continue;
      const double off = digits_off(q, q.in_big(sample), table.text(row, q.column), digits);
      EXPECT_LE(off, 1.0) << q.name << " at " << table.where(row) << ": " << describe(in);
      worst = std::max(worst, off);
      ++cells;
    }
  }
  std::printf("  %zu cells to %d digits, at most %.2g of the last\n", cells, digits, worst);
  EXPECT_GT(cells, 2000U);
}

TEST(FiftyDigits, RepeatTheOrdinaryTableToItsLastDigit) {
  expect_all_digits(TruthTable("ordinary"), truth::ordinary_digits, 100);
}

TEST(FiftyDigits, RepeatTheHardTableToItsLastDigit) { expect_all_digits(TruthTable("hard"), truth::hard_digits, 1); }

// ---- Every combination against the definitions ---------------------------------------------------------------------

template <class R>
R slope_met(AnisotropyForm form, const R& phi, const R& x, const R& y) {
  if (form == AnisotropyForm::consistent) return truth::slope_along(phi, x, y);
  return 1 / sqrt(truth::square(R(truth::cos_deg(phi) / x)) + truth::square(R(truth::sin_deg(phi) / y)));
}

truth::Slopes<Hundred> slopes_of(const ShapeSettings& settings, const truth::Quantities<Hundred>& q) {
  if (!settings.anisotropic) return truth::Slopes<Hundred>::isotropic(q);
  return {slope_met(settings.forms.anisotropy, q.phi_i, q.slope, q.slope_y),
          slope_met(settings.forms.anisotropy, q.phi_r, q.slope, q.slope_y), q.slope, q.slope_y};
}

Hundred shadowing_of(ShadowingTier tier, const Hundred& slope, const Hundred& c) {
  switch (tier) {
    case ShadowingTier::li_torrance:
      return truth::shadowing_lt(slope, c);
    case ShadowingTier::smith:
      return truth::shadowing_smith(slope, c);
    case ShadowingTier::schlick:
      return truth::shadowing_schlick(slope, c);
    case ShadowingTier::none:
      break;
  }
  return 1;
}

Hundred roughness_of(EffectiveRoughnessTier tier, const truth::Slopes<Hundred>& m, const truth::Geometry<Hundred>& p) {
  switch (tier) {
    case EffectiveRoughnessTier::li_torrance:
      return truth::effective_roughness_lt(m.along_i, m.along_r, p.l.z, p.v.z);
    case EffectiveRoughnessTier::he:
      return truth::effective_roughness_he(m.along_i, m.along_r, p.l.z, p.v.z);
    case EffectiveRoughnessTier::none:
      break;
  }
  return 1;
}

/// Student's t on an anisotropic surface: elliptic contours, s_x²/m_x² + s_y²/m_y² for tan²/m² of definitions.h.
Hundred log_student(const truth::Geometry<Hundred>& p, const Hundred& tail, const Hundred& m_x, const Hundred& m_y) {
  const Hundred sz2 = truth::square(p.s.z);
  const Hundred y = (truth::square(p.s.x) / truth::square(m_x) + truth::square(p.s.y) / truth::square(m_y)) / (4 * sz2);
  return log(Hundred(truth::square(Hundred(truth::dot(p.s, p.s) / p.s.z)) / (16 * m_x * m_y * sz2))) -
         tail * log(Hundred(1 + y / (tail - 1)));
}

Hundred defined_log_dd(const ShapeSettings& settings, const truth::Quantities<Hundred>& q) {
  const truth::Geometry<Hundred> p = q.geometry();
  const truth::Slopes<Hundred> m = slopes_of(settings, q);
  const truth::Attenuation<Hundred> a{
      shadowing_of(settings.shadowing, m.along_i, p.l.z) * shadowing_of(settings.shadowing, m.along_r, p.v.z),
      roughness_of(settings.effective_roughness, m, p)};
  const Hundred m_x = a.roughness * m.x;
  const Hundred m_y = a.roughness * m.y;
  if (settings.distribution == DistributionTier::rough_limit) return truth::log_dd_rough(p, m, a);
  if (settings.distribution == DistributionTier::student_t) {
    const Hundred d = settings.anisotropic ? log_student(p, q.tail, m_x, m_y) : truth::log_d_student_t(p, q.tail, m_x);
    return truth::log_dd(p, a.shadowing, d);
  }
  return truth::log_dd_ht(q, p, m, a,
                          [](const Hundred& g, const Hundred& x) { return truth::he_torrance_sum(g, x).log_w; });
}

Hundred defined_log_fs(const ShapeSettings& settings, const truth::Quantities<Hundred>& q) {
  const truth::Geometry<Hundred> p = q.geometry();
  const truth::Slopes<Hundred> m = slopes_of(settings, q);
  const Hundred ratio = roughness_of(settings.effective_roughness, m, p);
  const auto order = settings.forms.fs == FsForm::printed ? truth::FsOrder::printed : truth::FsOrder::reciprocal;
  return truth::log_fs(p, Hundred(ratio * m.x), Hundred(ratio * m.y), order);
}

/// Of logarithms, over 1 + the larger.
double difference(const Big& got, const Hundred& truth) {
  const Hundred wide(got.str(60, std::ios_base::scientific));
  return static_cast<double>(Hundred(abs(wide - truth) / (1 + abs(truth))));
}

// Student's t with its Smith shadowing is left out: that is a quadrature in double, with a test of its own.
bool defined(const ShapeSettings& s) {
  return s.shadowing != ShadowingTier::smith || s.distribution != DistributionTier::student_t;
}

TEST(FiftyDigits, EveryCombinationIsItsDefinition) {
  const std::vector<Inputs> rows = spread_rows(3300, 43);
  double worst = 0.0;
  for (const ShapeSettings& settings : combinations()) {
    if (!defined(settings)) continue;
    for (const Inputs& in : rows) {
      if (settings.wave_optics() && in.sigma_um > in.wavelength_um) continue;
      const Sample<Big> sample = sample_of<Big>(in, test::big_pair_of(truth::angles_of(in)));
      const truth::Quantities<Hundred> q(in);
      if (settings.forms.fs == FsForm::printed) {
        const double error = difference(dd(settings, sample).log, defined_log_dd(settings, q));
        EXPECT_LT(error, 1e-35) << "dd " << name_of(settings) << " at " << describe(in);
        worst = std::max(worst, error);
      }
      if (settings.shadowing != ShadowingTier::none || settings.wave_optics()) continue;
      const Outcome<Big> forward = fs(settings, sample);
      const Hundred truth = defined_log_fs(settings, q);
      EXPECT_EQ(forward.value == 0 && !sample.pair.forward, isinf(truth) && !sample.pair.forward) << describe(in);
      if (isinf(truth)) continue;
      const double error = difference(forward.log, truth);
      EXPECT_LT(error, 1e-35) << "fs " << name_of(settings) << " at " << describe(in);
      worst = std::max(worst, error);
    }
  }
  std::printf("  combinations against definitions: %.2g\n", worst);
}

}  // namespace
}  // namespace goniofit::stability
