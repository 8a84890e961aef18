// The committed tables against the program that made them: rows recomputed from the definitions must repeat every
// digit, so that tables and definitions cannot drift apart. And the definitions against what is known in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "inputs.h"
#include "models.h"
#include "oren_nayar_definitions.h"
#include "oren_nayar_integral.h"
#include "side_tables.h"
#include "support/truth_table.h"
#include "table_inputs.h"

namespace goniofit::truth {
namespace {

using test::TruthTable;

/// g = (2 pi 2 sigma/lambda)² of 1e6 and more sums for seconds.
bool quick(const TruthTable& table, std::size_t row) {
  return table.number(row, "sigma_um") < 30 * table.number(row, "wavelength_um");
}

/// About forty rows spread over the table, each compared cell by cell.
void expect_no_drift(Table which, const TruthTable& table) {
  ASSERT_EQ(table.header(), header(which));
  const std::size_t stride = table.size() / 40;
  std::size_t compared = 0;
  for (std::size_t row = stride / 2; row < table.size(); row += stride) {
    if (!quick(table, row)) continue;
    const std::vector<std::string> again = cells(which, inputs_of(table, row));
    for (std::size_t i = 0; i < again.size(); ++i)
      EXPECT_EQ(again[i], table.cells(row)[i]) << table.where(row) << ": " << table.header()[i];
    ++compared;
  }
  EXPECT_GE(compared, 35U);
}

TEST(TruthTables, OrdinaryRowsRepeatEveryDigit) { expect_no_drift(Table::ordinary, TruthTable("ordinary")); }

TEST(TruthTables, HardRowsRepeatEveryDigit) { expect_no_drift(Table::hard, TruthTable("hard")); }

TEST(TruthTables, HardRowsAreTheCornersListed) {
  const TruthTable table("hard");
  const std::vector<Inputs> corners = hard_inputs();
  ASSERT_EQ(table.size(), corners.size());
  for (std::size_t row = 0; row < corners.size(); ++row) {
    EXPECT_EQ(table.corner(row), corners[row].corner) << table.where(row);
    for (const InputColumn& column : input_columns())
      EXPECT_EQ(table.number(row, column.name), corners[row].*column.value) << table.where(row) << ": " << column.name;
  }
}

// Every number is there: a definition that broke down in a corner would leave a nan.
TEST(TruthTables, NoCellIsNan) {
  for (const char* name : {"ordinary", "hard", "lobe_sum", "oren_nayar_integral"}) {
    const TruthTable table(name);
    for (std::size_t row = 0; row < table.size(); ++row) {
      for (std::size_t i = 0; i < table.header().size(); ++i) {
        if (table.header()[i] == "corner") continue;
        EXPECT_FALSE(std::isnan(table.number(row, i))) << table.where(row) << ": " << table.header()[i];
      }
    }
  }
}

TEST(TruthTables, LobeSumsRepeatEveryDigit) {
  const TruthTable table("lobe_sum");
  const std::vector<LobeInputs> rows = lobe_inputs();
  ASSERT_EQ(table.size(), rows.size());
  for (std::size_t row = 0; row < rows.size(); row += 7) {
    if (rows[row].g > 3e4) continue;
    EXPECT_EQ(joined(table.cells(row)), lobe_line(rows[row])) << table.where(row);
  }
}

// In long double through the machine's libm: eleven digits, not text.
TEST(TruthTables, OrenNayarIntegralsRepeat) {
  const TruthTable table("oren_nayar_integral");
  for (std::size_t row = 0; row < table.size(); row += 17) {
    const OrenNayarIntegral again =
        oren_nayar_integral(table.number(row, "theta_i"), table.number(row, "theta_r"), table.number(row, "delta_phi"),
                            table.number(row, "facet_slope_deg"), 3);
    const double direct = table.number(row, "direct");
    const double interreflection = table.number(row, "interreflection");
    EXPECT_NEAR(static_cast<double>(again.direct), direct, 1e-11 * direct) << table.where(row);
    EXPECT_NEAR(static_cast<double>(again.interreflection), interreflection, 1e-11 * interreflection)
        << table.where(row);
  }
}

double relative(const Real& a, const Real& b) { return static_cast<double>(abs(a / b - 1)); }

// The continued fraction beyond 4 and MPFR's own erfc.
TEST(Definitions, ErfcAgreesWithMpfr) {
  for (const double x : {0.0, 0.5, 3.9, 4.0, 4.7, 6.0, 9.5, 15.0, 26.0}) {
    Digits<120> argument(x);
    Digits<120> value;
    mpfr_erfc(value.backend().data(), argument.backend().data(), MPFR_RNDN);
    EXPECT_LT(relative(Real(complementary_error(argument)), Real(value)), 1e-75) << x;
  }
}

// At normal incidence Fresnel's complex arithmetic is [(n-1)² + kappa²] / [(n+1)² + kappa²]; at Brewster's angle
// tan = n the p part vanishes, and Rs = [(1-n²)/(1+n²)]².
TEST(Definitions, FresnelAtItsKnownAngles) {
  const Real n("1.5");
  const Real kappa("2.25");
  EXPECT_LT(relative(fresnel_exact(n, kappa, Real(1)),
                     (square(Real(n - 1)) + square(kappa)) / (square(Real(n + 1)) + square(kappa))),
            1e-60);
  const Real brewster = 1 / sqrt(1 + n * n);
  EXPECT_LT(relative(fresnel_exact(n, Real(0), brewster), square(Real((1 - n * n) / (1 + n * n))) / 2), 1e-60);
}

// HT (80)'s root satisfies Lambert's form: with W = (z0/sigma)², W e^W = K²/(8 pi).
TEST(Definitions, EffectiveRoughnessSolvesLambertsEquation) {
  for (const double slope : {0.05, 0.3, 2.0}) {
    const Real m(slope);
    const Real c_i = cos_deg(Real(70));
    const Real c_r = cos_deg(Real("89.5"));
    const Real w = 1 / square(effective_roughness_he(m, m, c_i, c_r)) - 1;
    const Real k = shadow_slope(m, c_i) + shadow_slope(m, c_r);
    EXPECT_LT(relative(Real(w * exp(w)), Real(k * k / (8 * pi<Real>()))), 1e-60) << slope;
  }
}

// For g to infinity W is e^(-x/g)/g: the next order is 1/g.
TEST(Definitions, LobeSumApproachesTheRoughLimit) {
  for (const double y : {0.0, 0.5, 2.0}) {
    const Real g(1e5);
    const Real limit = -y - log(g);
    EXPECT_LT(std::fabs(static_cast<double>(he_torrance_sum(g, Real(y * 1e5)).log_w - limit)), 4e-5) << y;
  }
}

// x = 0 and g small: g e^-g (1 + g/4 + g²/18 + ...).
TEST(Definitions, LobeSumOfAFewTerms) {
  const Real g(0.001);
  const Real few = g * exp(-g) * (1 + g / 4 + g * g / 18 + g * g * g / 96 + g * g * g * g / 600);
  EXPECT_LT(relative(exp(he_torrance_sum(g, Real(0)).log_w), few), 1e-17);
}

// Rough-limit D is pi/4 of Beckmann's at alpha = 2 m, and of student-t's as the tail goes to infinity.
TEST(Definitions, SlopeDistributionsMeetBeckmann) {
  const Geometry<Real> p(Real(30), Real(0), Real(50), Real(170));
  const Real m("0.2");
  const Real alpha2 = square(Real(2 * m));
  const Real beckmann = exp(-p.tan2_b / alpha2) * square(Real(1 + p.tan2_b)) / (pi<Real>() * alpha2);
  const Real rough = log_d_rough_limit(p, m, m);
  EXPECT_LT(relative(exp(rough), Real(beckmann * pi<Real>() / 4)), 1e-60);
  EXPECT_NEAR(static_cast<double>(log_d_student_t(p, Real(1e12), m) - rough), 0.0, 1e-11);
}

// The consistent anisotropic forms at equal slopes are the isotropic ones, at any azimuth.
TEST(Definitions, AnisotropyOfEqualSlopesIsNone) {
  EXPECT_LT(relative(slope_along(Real(37), Real("0.3"), Real("0.3")), Real("0.3")), 1e-60);
}

// Facets all horizontal are Lambert's surface; the functional form is a fit within 5 % for facet slopes of 30°.
TEST(Definitions, OrenNayarIntegralNearItsFunctionalForm) {
  const OrenNayarIntegral flat = oren_nayar_integral(40, 50, 120, 0.01, 3);
  EXPECT_NEAR(static_cast<double>(flat.direct), 1 / 3.14159265358979, 1e-6);
  EXPECT_NEAR(static_cast<double>(flat.interreflection), 0.0, 1e-4);
  for (const double phi : {0.0, 60.0, 180.0}) {
    const OrenNayarIntegral exact = oren_nayar_integral(30, 50, phi, 30, 3);
    const OrenNayarAngles<Real> a(Real(30), Real(0), Real(50), Real(phi), Real(30));
    EXPECT_NEAR(static_cast<double>(oren_nayar_direct(a)) / static_cast<double>(exact.direct), 1.0, 0.05) << phi;
  }
}

// Swapping L and V leaves the integral's f alone.
TEST(Definitions, OrenNayarIntegralIsReciprocal) {
  const OrenNayarIntegral one = oren_nayar_integral(30, 75, 110, 20, 3);
  const OrenNayarIntegral other = oren_nayar_integral(75, 30, 110, 20, 3);
  EXPECT_NEAR(static_cast<double>(one.direct / other.direct), 1.0, 1e-11);
  EXPECT_NEAR(static_cast<double>(one.interreflection / other.interreflection), 1.0, 1e-11);
}

}  // namespace
}  // namespace goniofit::truth
