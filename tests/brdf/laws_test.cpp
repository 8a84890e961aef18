// What every effect obeys, over random materials and directions with the corners drawn often.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "brdf/evaluator.h"
#include "support/materials.h"

namespace goniofit {
namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double theta() {
    switch (static_cast<int>(uniform(0, 6))) {
      case 0:
        return 0.0;
      case 1:
        return log_uniform(1e-12, 1e-2);
      case 2:
        return 90.0 - log_uniform(1e-10, 1.0);
      default:
        return uniform(0.0, 90.0);
    }
  }
  AnglePair angles() {
    AnglePair a{theta(), uniform(-180, 180), theta(), uniform(-180, 180)};
    const int kind = static_cast<int>(uniform(0, 5));
    if (kind == 0) a.theta_r_deg = a.theta_i_deg;
    if (kind <= 1) a.phi_r_deg = a.phi_i_deg + 180.0;
    if (kind == 2) a.phi_r_deg = a.phi_i_deg;
    return a;
  }
  Material material() {
    Material m;
    m.name = "drawn";
    for (const Effect e : all_effects) m.components.insert(e);
    const double slope = log_uniform(1e-6, 10.0);
    const double sigma = log_uniform(1e-6, 500.0);
    m.surface = {slope, sigma, sigma / slope};
    m.terms.fresnel = uniform(0, 1) < 0.5 ? FresnelTier::schlick : FresnelTier::exact;
    const bool metal = uniform(0, 1) < 0.5;
    m.channels = {test::channel("R", uniform(0.3, 10.0), metal ? uniform(0.05, 6.0) : uniform(1.0, 4.0),
                                metal ? log_uniform(1e-3, 1e3) : 0.0, uniform(0, 1), uniform(0, 1), uniform(0, 1),
                                uniform(0, 3))};
    m.fs_form = uniform(0, 1) < 0.5 ? FsForm::printed : FsForm::reciprocal;
    return m;
  }

 private:
  std::mt19937_64 random_;
};

TEST(Laws, FiniteNonNegativeAndReciprocal) {
  Draw draw(11);
  for (int trial = 0; trial < 20000; ++trial) {
    const Material m = draw.material();
    const Evaluator e(m);
    for (int direction = 0; direction < 5; ++direction) {
      const AnglePair a = draw.angles();
      const Pair p = make_pair(a);
      const Pair q = make_pair(swapped(a));
      const double f = e.value(p, 0);
      ASSERT_TRUE(std::isfinite(f)) << *m.surface.slope << " " << a.theta_i_deg << " " << a.theta_r_deg;
      ASSERT_GE(f, 0.0);
      ASSERT_LE(f, saturation);
      for (const Effect effect : {Effect::dd, Effect::udf, Effect::uds, Effect::fs}) {
        if (effect == Effect::fs && m.fs_form == FsForm::printed) continue;  // not reciprocal, as effects_test measures
        const double one = e.value(p, 0, effect);
        const double other = e.value(q, 0, effect);
        // Where the exponent is large, so is the effect of a rounding of it.
        const double allowed =
            1e-11 * (1.0 + std::fabs(std::log(std::max(one, 1e-300)))) / std::min(1.0, 1e4 * *m.surface.slope);
        ASSERT_LE(std::fabs(one - other), allowed * one + 1e-280)
            << name_of(effect) << " slope " << *m.surface.slope << " at " << a.theta_i_deg << ", " << a.theta_r_deg;
      }
    }
  }
}

TEST(Laws, IsotropicSurfacesReadTheAzimuthDifferenceOnly) {
  Draw draw(12);
  for (int trial = 0; trial < 2000; ++trial) {
    const Evaluator e(draw.material());
    AnglePair a = draw.angles();
    a.phi_i_deg = std::floor(a.phi_i_deg);
    a.phi_r_deg = std::floor(a.phi_r_deg);
    AnglePair turned = a;
    turned.phi_i_deg += 90.0;
    turned.phi_r_deg += 90.0;
    ASSERT_EQ(e.value(make_pair(a), 0), e.value(make_pair(turned), 0));
    AnglePair mirrored = a;
    mirrored.phi_i_deg = -a.phi_i_deg;
    mirrored.phi_r_deg = -a.phi_r_deg;
    ASSERT_EQ(e.value(make_pair(a), 0), e.value(make_pair(mirrored), 0));
  }
}

}  // namespace
}  // namespace goniofit
