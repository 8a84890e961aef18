#include "fit/noise_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace goniofit {
namespace {

TEST(NoiseModel, FindsBothPartsAmongGrossErrors) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> gauss;
  constexpr Eigen::Index n = 4000;
  Eigen::VectorXd f(n);
  Eigen::VectorXd r(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    f[i] = std::pow(10.0, -4.0 + 5.0 * static_cast<double>(i) / static_cast<double>(n));
    r[i] = gauss(random) * std::hypot(0.03 * f[i], 0.002);
    if (i % 20 == 0) r[i] = 10.0;  // 5 % are wild
  }
  const Noise noise = estimate_noise(f, r);
  EXPECT_NEAR(noise.relative, 0.03, 0.004);
  EXPECT_NEAR(noise.additive, 0.002, 0.0003);
}

TEST(NoiseModel, OfFewOrAlikeOrNoReadings) {
  EXPECT_EQ(estimate_noise(Eigen::VectorXd(0), Eigen::VectorXd(0)).additive, 0.0);
  const Noise exact = estimate_noise(Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d::Zero());
  EXPECT_LT(exact.sd(2.0), 1e-5);
  EXPECT_GT(exact.sd(2.0), 0.0);
  const Noise alike = estimate_noise(Eigen::VectorXd::Constant(50, 0.3), Eigen::VectorXd::Constant(50, -0.01));
  EXPECT_NEAR(alike.sd(0.3), 0.014826, 1e-6) << "all are 0.674 standard deviations";
}

}  // namespace
}  // namespace goniofit
