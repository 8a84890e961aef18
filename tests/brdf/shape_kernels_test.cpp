// The kernels of the fits against the formulas they stand for, on dual numbers.

#include "brdf/shape_kernels.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/samplings.h"

namespace goniofit {
namespace {

using Dual = ceres::Jet<double, 1>;

PairBatch ordinary_and_extreme_pairs() {
  std::vector<AnglePair> angles = hemisphere_sampling(true);
  for (const double theta : {0.0, 1e-5, 1e-3, 45.0, 88.0, 89.9, 89.99999}) {
    for (const double r : {0.0, theta, -theta, 45.0, -45.0, 89.0}) angles.push_back(in_plane(theta, r));
  }
  return PairBatch(angles);
}

struct Worst {
  double value = 0.0, derivative = 0.0;

  /// Both have the error of the exponent, which is that of its rounding; where the batch's exponential ends, both are
  /// zero for any purpose.
  void add(double value_of_batch, double derivative_of_batch, const Dual& f) {
    constexpr double nil = 1e-250;
    if (f.a < nil) {
      EXPECT_LT(value_of_batch, nil);
      EXPECT_LT(std::fabs(derivative_of_batch), 1e4 * nil);
      return;
    }
    if (f.a > 1e290) return;
    const double conditioned = 1.0 + std::fabs(std::log(f.a));
    value = std::max(value, std::fabs(value_of_batch - f.a) / (conditioned * f.a));
    derivative =
        std::max(derivative, std::fabs(derivative_of_batch - f.v[0]) / (conditioned * (f.a + std::fabs(f.v[0]))));
  }
};

Worst compare(const PairBatch& pairs, const ShapeSettings& settings, double slope) {
  const SurfaceParameters<Dual> surface{.log_slope = Dual(std::log(slope), 0)};
  const std::size_t n = pairs.size();
  std::vector<double> dd(n), d_dd(n), fs(n), d_fs(n);
  shape_columns(pairs, settings, surface.log_slope.a, {dd.data(), d_dd.data()}, {fs.data(), d_fs.data()});
  Worst worst;
  for (std::size_t i = 0; i < n; ++i) {
    const Pair p = pairs[i];
    const SurfaceTerms<Dual> t = surface_terms(settings, surface, p);
    worst.add(dd[i], d_dd[i], dd_shape(settings, surface, t, 1.0, p));
    worst.add(fs[i], d_fs[i], fs_shape(settings, surface, t, p));
  }
  return worst;
}

TEST(ShapeKernels, DerivativesAreThoseOfTheFormulas) {
  const PairBatch pairs = ordinary_and_extreme_pairs();
  Worst worst;
  for (const ShadowingTier shadowing : {ShadowingTier::li_torrance, ShadowingTier::none}) {
    for (const EffectiveRoughnessTier roughness : {EffectiveRoughnessTier::li_torrance, EffectiveRoughnessTier::none}) {
      for (const FsForm form : {FsForm::printed, FsForm::reciprocal}) {
        for (const double slope : {1e-6, 1e-4, 1e-3, 0.011, 0.172, 0.6, 10.0}) {
          const Worst here =
              compare(pairs, {.shadowing = shadowing, .effective_roughness = roughness, .forms = {.fs = form}}, slope);
          worst.value = std::max(worst.value, here.value);
          worst.derivative = std::max(worst.derivative, here.derivative);
        }
      }
    }
  }
  EXPECT_LT(worst.value, 1e-14);
  EXPECT_LT(worst.derivative, 1e-14);
}

// One column without the other, in batches that end within a block and within a vector.
TEST(ShapeKernels, ColumnsDoNotDependOnWhatElseIsAsked) {
  const PairBatch all = ordinary_and_extreme_pairs();
  std::vector<std::size_t> rows(std::min<std::size_t>(all.size(), 301));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
  const PairBatch pairs = all.subset(rows);
  const std::size_t n = pairs.size();
  std::vector<double> both(4 * n), alone(4 * n), values(2 * n);
  const auto column = [n](std::vector<double>& v, std::size_t k) {
    return ColumnWithDerivative{v.data() + k * n, v.data() + (k + 1) * n};
  };
  const double log_slope = std::log(0.3);
  shape_columns(pairs, {}, log_slope, column(both, 0), column(both, 2));
  shape_columns(pairs, {}, log_slope, column(alone, 0), {});
  shape_columns(pairs, {}, log_slope, {}, column(alone, 2));
  shape_columns(pairs, {}, log_slope, values.data(), values.data() + n);
  EXPECT_EQ(both, alone);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(both[i], values[i], 1e-14 * values[i]);
    EXPECT_NEAR(both[2 * n + i], values[n + i], 1e-14 * values[n + i]);
  }
}

}  // namespace
}  // namespace goniofit
