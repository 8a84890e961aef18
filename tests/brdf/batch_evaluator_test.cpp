// The compiled evaluator against the scalar one, which the other tests hold to the definitions.

#include "brdf/batch_evaluator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "brdf/evaluator.h"
#include "brdf/surface_shape.h"
#include "geometry/samplings.h"
#include "peers/peers.h"
#include "support/error.h"
#include "support/extreme_materials.h"
#include "support/materials.h"
#include "support/random_directions.h"

namespace goniofit {
namespace {

// |a - b| / b / (1 + |ln b| + further logarithms), where b is a value that both have to have.
double deviation(double batch, double scalar, double least, double most, double logarithms = 0.0) {
  if (scalar < least) return batch < 10.0 * least ? 0.0 : 1.0;
  if (scalar >= most) return batch >= 0.99 * most ? 0.0 : 1.0;
  return std::fabs(batch / scalar - 1.0) / (1.0 + std::fabs(std::log(scalar)) + logarithms);
}

// What cancels in a value of student-t: towards grazing ln sigma_e falls to -1e6 on the smoothest surfaces, and D to a
// power of it only.
double cancelling(const Material& m, const Pair& p) {
  if (m.model != surface_model || !m.surface.slope || m.terms.distribution != DistributionTier::student_t) return 0.0;
  const double across = std::log(m.surface.slope_y.value_or(*m.surface.slope));
  const SurfaceParameters<double> s{.log_slope = std::log(*m.surface.slope), .log_slope_y = across};
  ShapeSettings settings = ShapeSettings::of(m.terms, m.forms, m.surface.anisotropic());
  settings.shadowing = ShadowingTier::none;
  return std::fabs(surface_terms(settings, s, p).log_height_ratio) * m.surface.tail.value_or(1.0);
}

struct Worst {
  double error = 0.0;
  std::string where;

  void see(double e, const std::string& at) {
    if (e <= error) return;
    error = e;
    where = at;
  }
};

std::string text(const Material& m, const AnglePair& a) {
  const auto number = [](const std::optional<double>& x) { return x ? std::to_string(*x) : std::string("-"); };
  std::string out =
      m.model + " F " + std::string(name_of(m.terms.fresnel)) + " S " + std::string(name_of(m.terms.shadowing)) +
      " s_e " + std::string(name_of(m.terms.effective_roughness)) + " D " + std::string(name_of(m.terms.distribution)) +
      " slope " + number(m.surface.slope) + " slope_y " + number(m.surface.slope_y) + " n " + number(m.channels[0].n) +
      " kappa " + number(m.channels[0].kappa);
  char angles[160];
  std::snprintf(angles, sizeof angles, " at %.17g %.17g %.17g %.17g", a.theta_i_deg, a.phi_i_deg, a.theta_r_deg,
                a.phi_r_deg);
  return out + angles;
}

std::string values(double a, double b) {
  char out[80];
  std::snprintf(out, sizeof out, ": %.17g, %.17g", a, b);
  return out;
}

bool is_wave(const Material& m) { return m.terms.distribution == DistributionTier::he_torrance; }

struct Batch {
  std::vector<AnglePair> angles;
  PairBatch pairs;
  DirectionBatch directions;

  explicit Batch(std::vector<AnglePair> a) : angles(std::move(a)), pairs(angles) {
    for (const AnglePair& x : angles) {
      directions.push_back(direction_of(x.theta_i_deg, x.phi_i_deg), direction_of(x.theta_r_deg, x.phi_r_deg));
    }
  }
  [[nodiscard]] Pair of_directions(std::size_t i) const {
    const DirectionBatch& d = directions;
    return make_pair(Direction{d.l_x[i], d.l_y[i], d.l_z[i]}, Direction{d.v_x[i], d.v_y[i], d.v_z[i]});
  }
};

Batch corners(test::Draw& draw, std::size_t n) {
  std::vector<AnglePair> angles;
  for (std::size_t i = 0; i < n; ++i) angles.push_back(draw.angles());
  return Batch(std::move(angles));
}

constexpr double least_double = 1e-240;

class EveryInstructionSet : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (GetParam() > best_instruction_set()) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  }
};
std::string test_name(const testing::TestParamInfo<InstructionSet>& set) {
  return std::array{"sse2", "avx2", "avx512"}[static_cast<std::size_t>(set.param)];
}
INSTANTIATE_TEST_SUITE_P(BatchEvaluator, EveryInstructionSet, testing::ValuesIn(all_instruction_sets), test_name);

// Materials and directions at the limits of what is valid, every tier, effect, form and peer.
TEST_P(EveryInstructionSet, AgreesWithTheScalarReference) {
  test::ExtremeMaterials materials(11);
  Worst elementary;
  Worst wave;
  for (int k = 0; k < 1500; ++k) {
    const Material m = materials.next();
    const Batch batch = corners(materials.draw(), 37);
    const Evaluator scalar(m);
    const BatchEvaluator<double> compiled(m, {.instructions = GetParam()});
    std::vector<double> by_pairs(batch.angles.size());
    std::vector<double> by_directions(batch.angles.size());
    compiled.values(batch.pairs, by_pairs);
    compiled.values(batch.directions, by_directions);
    for (std::size_t i = 0; i < batch.angles.size(); ++i) {
      ASSERT_TRUE(std::isfinite(by_pairs[i]) && by_pairs[i] >= 0.0 && by_pairs[i] <= saturation)
          << text(m, batch.angles[i]);
      ASSERT_TRUE(std::isfinite(by_directions[i]) && by_directions[i] >= 0.0 && by_directions[i] <= saturation)
          << text(m, batch.angles[i]);
      Worst& worst = is_wave(m) ? wave : elementary;
      const std::string at = text(m, batch.angles[i]);
      const double most = saturation * 1e-4;
      const double of_pair = scalar.value(batch.pairs[i], 0);
      const double of_directions = scalar.value(batch.of_directions(i), 0);
      const double least = is_wave(m) ? 1e-100 : least_double;
      const double cancels = cancelling(m, batch.pairs[i]);
      worst.see(deviation(by_pairs[i], of_pair, least, most, cancels), at + " (pair)" + values(by_pairs[i], of_pair));
      worst.see(deviation(by_directions[i], of_directions, least, most, cancels),
                at + " (directions)" + values(by_directions[i], of_directions));
    }
  }
  std::printf("largest error / (1 + |ln f|): %.1e %s\n  of wave optics: %.1e %s\n", elementary.error,
              elementary.where.c_str(), wave.error, wave.where.c_str());
  EXPECT_LE(elementary.error, 1e-13);
  EXPECT_LE(wave.error, 2e-9);
}

// Single precision: what the pair's own rounding does to the exponent of a lobe is part of it, hence smooth surfaces
// are compared at the rounded pair.
TEST_P(EveryInstructionSet, SinglePrecisionAgreesToFiveDigits) {
  Worst worst;
  for (const double slope : {0.005, 0.02, 0.0722, 0.172, 0.5, 2.0}) {
    for (const ShadowingTier shadowing : {ShadowingTier::li_torrance, ShadowingTier::smith, ShadowingTier::schlick}) {
      for (const EffectiveRoughnessTier roughness :
           {EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::he, EffectiveRoughnessTier::none}) {
        for (const FresnelTier fresnel : {FresnelTier::schlick, FresnelTier::exact}) {
          Material m = test::laser_paper_73();
          m.channels.resize(1);
          m.surface = test::slope_alone(slope);
          m.terms = {fresnel, shadowing, roughness, DistributionTier::rough_limit};
          const FloatPairBatch pairs(PairBatch(hemisphere_sampling(true)));
          std::vector<float> values(pairs.size());
          BatchEvaluator<float>(m, {.instructions = GetParam()}).values(pairs, values);
          const Evaluator scalar(m);
          for (std::size_t i = 0; i < pairs.size(); ++i) {
            const double truth = scalar.value(pairs.as<double>(i), 0);
            worst.see(deviation(double(values[i]), truth, 1e-20, 1e29), text(m, {}) + " " + std::to_string(i));
          }
        }
      }
    }
  }
  std::printf("largest error / (1 + |ln f|) in single precision: %.1e %s\n", worst.error, worst.where.c_str());
  EXPECT_LE(worst.error, 1e-5);
}

// Where there is any light to speak of, 1e-5 of the peak and more.
TEST_P(EveryInstructionSet, ToleranceHolds) {
  for (const double tolerance : {1e-9, 1e-6, 1e-4}) {
    Worst worst;
    for (Material m :
         {test::garnet_red_paint_13(), test::laser_paper_73(), test::ground_glass_41(), test::smooth_aluminium_45()}) {
      for (const Terms& terms :
           {Terms{}, test::he_torrance_terms(),
            Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he, DistributionTier::student_t}}) {
        m.terms = terms;
        m.surface.tail.reset();
        if (terms.distribution == DistributionTier::student_t) m.surface.tail = 2.5;
        const Batch batch(hemisphere_sampling(true));
        const Evaluator scalar(m);
        const BatchEvaluator<double> compiled(m, {.tolerance = tolerance, .instructions = GetParam()});
        std::vector<double> values(batch.angles.size() * m.channels.size());
        compiled.values(batch.directions, values);
        for (std::size_t c = 0; c < m.channels.size(); ++c) {
          for (std::size_t i = 0; i < batch.angles.size(); ++i) {
            const double truth = scalar.value(batch.of_directions(i), c);
            if (truth < 1e-4) continue;
            worst.see(std::fabs(values[c * batch.angles.size() + i] / truth - 1.0), m.name + text(m, batch.angles[i]));
          }
        }
      }
    }
    std::printf("tolerance %.0e: %.1e %s\n", tolerance, worst.error, worst.where.c_str());
    EXPECT_LE(worst.error, tolerance == 1e-9 ? 2e-9 : tolerance);
  }
}

// A value does not depend on where in a batch its pair stands: whole vectors and what is left over are the same
// arithmetic. (W takes one or the other way by how many of a block go there, to the same 1e-9.)
TEST_P(EveryInstructionSet, PlaceInTheBatchDoesNotMatter) {
  test::Draw draw(3);
  const Batch batch = corners(draw, 600);
  for (const Terms& terms : {Terms{}, test::he_torrance_terms()}) {
    Material m = test::laser_paper_73();
    m.terms = terms;
    m.channels.resize(1);
    const BatchEvaluator<double> compiled(m, {.instructions = GetParam()});
    std::vector<double> all(600);
    compiled.values(batch.pairs, all);
    for (const std::size_t first : {1UL, 3UL, 255UL, 597UL}) {
      std::vector<std::size_t> rows;
      for (std::size_t i = first; i < 600; ++i) rows.push_back(i);
      std::vector<double> part(rows.size());
      compiled.values(batch.pairs.subset(rows), part);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double whole = all[rows[i]];
        EXPECT_NEAR(part[i], whole, is_wave(m) ? 2e-9 * whole : 0.0) << first << " " << i;
      }
    }
  }
}

// Nothing that an earlier evaluation left behind reaches a later one.
TEST(BatchEvaluator, ValuesDoNotDependOnWhatWasEvaluatedBefore) {
  test::Draw draw(5);
  const Batch batch = corners(draw, 259);
  Material m = test::laser_paper_73();
  m.terms = test::he_torrance_terms();
  const BatchEvaluator<double> compiled(m);
  std::vector<double> first(3 * 259);
  std::vector<double> again(first);
  compiled.values(batch.directions, first);
  const Batch other = corners(draw, 256);
  for (const Material& before : {test::smooth_aluminium_45(), test::rough_plaster(), test::ground_glass_41()}) {
    std::vector<double> ignored(256 * before.channels.size());
    BatchEvaluator<double>(before).values(other.directions, ignored);
    compiled.values(batch.directions, again);
    EXPECT_EQ(again, first);
  }
}

TEST(BatchEvaluator, ChannelsStandOneAfterTheOther) {
  const Material m = test::garnet_red_paint_13();
  const Batch batch(hemisphere_sampling(false));
  std::vector<double> values(3 * batch.angles.size());
  BatchEvaluator<double>(m).values(batch.pairs, values);
  const Evaluator scalar(m);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < batch.angles.size(); i += 17) {
      const double truth = scalar.value(batch.pairs[i], c);
      EXPECT_NEAR(values[c * batch.angles.size() + i], truth, 3e-12 * truth + 1e-12);
    }
  }
}

TEST(BatchEvaluator, OutsideTheHemisphereIsNothing) {
  DirectionBatch d;
  d.push_back({0.6, 0.0, 0.8}, {0.6, 0.0, -0.8});
  d.push_back({0.6, 0.0, -0.8}, {0.6, 0.0, 0.8});
  d.push_back({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  for (const Terms& terms : {Terms{}, test::he_torrance_terms()}) {
    Material m = test::laser_paper_73();
    m.terms = terms;
    m.channels.resize(1);
    std::vector<double> values(3, -1.0);
    BatchEvaluator<double>(m).values(d, values);
    EXPECT_EQ(values, (std::vector<double>{0.0, 0.0, 0.0}));
  }
}

TEST(BatchEvaluator, EmptyBatchAndBadMaterial) {
  const BatchEvaluator<double> compiled(test::laser_paper_73());
  compiled.values(PairBatch{}, {});
  Material bad = test::laser_paper_73();
  bad.surface.slope = -1.0;
  EXPECT_THROW(BatchEvaluator<double>{bad}, Error);
}

// LT (7) with its exponent put right: S1 = 1 where 1 - S1 = (1-c)^(tau/sigma) < 0.005.
TEST(BatchEvaluator, ShadowingShortcutIsOffByHalfAPercentAFactor) {
  Material m = test::ground_glass_41();
  m.components = {Effect::dd};
  m.channels.resize(1);
  const Batch batch(hemisphere_sampling(true));
  std::vector<double> exact(batch.angles.size());
  std::vector<double> cut(batch.angles.size());
  BatchEvaluator<double>(m).values(batch.pairs, exact);
  BatchEvaluator<double>(m, {.shadowing_shortcut = true}).values(batch.pairs, cut);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i] < 1e-280) continue;
    EXPECT_GE(cut[i], exact[i] * (1.0 - 1e-13));
    worst = std::max(worst, cut[i] / exact[i] - 1.0);
  }
  EXPECT_LE(worst, 1.0 / (0.995 * 0.995) - 1.0 + 1e-12);
  EXPECT_GE(worst, 0.002);  // it does something
}

}  // namespace
}  // namespace goniofit
