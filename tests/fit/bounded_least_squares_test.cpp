#include "fit/bounded_least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>

namespace goniofit {
namespace {

// Every assignment of lower, upper or free: the least value among those whose free part lies inside. Exponential and
// certain.
double brute_force(const SmallMatrix& g, const SmallVector& b, const SmallVector& lower, const SmallVector& upper) {
  const auto n = static_cast<int>(b.size());
  int faces = 1;
  for (int i = 0; i < n; ++i) faces *= 3;
  double best = std::numeric_limits<double>::infinity();
  for (int face = 0; face < faces; ++face) {
    SmallVector x = SmallVector::Zero(n);
    std::vector<int> free;
    bool possible = true;
    for (int i = 0, code = face; i < n; ++i, code /= 3) {
      if (code % 3 == 0) {
        free.push_back(i);
        continue;
      }
      x[i] = code % 3 == 1 ? lower[i] : upper[i];
      possible = possible && std::isfinite(x[i]);
    }
    if (!possible) continue;
    if (!free.empty()) {
      const auto m = static_cast<Eigen::Index>(free.size());
      Eigen::MatrixXd a(m, m);
      Eigen::VectorXd r(m);
      for (Eigen::Index i = 0; i < m; ++i) {
        const int fi = free[static_cast<std::size_t>(i)];
        r[i] = b[fi] - g.row(fi) * x;
        for (Eigen::Index j = 0; j < m; ++j) a(i, j) = g(fi, free[static_cast<std::size_t>(j)]);
      }
      const Eigen::VectorXd y = a.completeOrthogonalDecomposition().solve(r);
      for (Eigen::Index i = 0; i < m; ++i) x[free[static_cast<std::size_t>(i)]] = y[i];
    }
    bool inside = true;
    for (int i = 0; i < n; ++i) inside = inside && x[i] >= lower[i] - 1e-12 && x[i] <= upper[i] + 1e-12;
    if (inside) best = std::min(best, x.dot(g * x) - 2.0 * x.dot(b));
  }
  return best;
}

TEST(BoundedLeastSquares, AgreesWithEveryFaceTried) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 5000; ++trial) {
    const int n = 1 + trial % 5;
    Eigen::MatrixXd a(8, n);
    Eigen::VectorXd y(8);
    for (int i = 0; i < 8; ++i) {
      y[i] = normal(random);
      for (int j = 0; j < n; ++j) a(i, j) = normal(random);
    }
    if (trial % 7 == 0 && n > 1) a.col(1) = a.col(0) + 1e-4 * a.col(1);  // nearly dependent
    SmallVector lower(n);
    SmallVector upper(n);
    for (int j = 0; j < n; ++j) {
      lower[j] = uniform(random) < 0.7 ? 0.0 : -0.5;
      upper[j] = uniform(random) < 0.7 ? 1.0 : std::numeric_limits<double>::infinity();
      if (uniform(random) < 0.1) upper[j] = lower[j];
    }
    const SmallMatrix g = a.transpose() * a;
    const SmallVector b = a.transpose() * y;
    const BoundedSolution s = solve_bounded(g, b, lower, upper);
    const double expected = brute_force(g, b, lower, upper);
    ASSERT_NEAR(s.value, expected, 1e-8 * (1.0 + std::fabs(expected))) << trial;
    for (int j = 0; j < n; ++j) {
      ASSERT_GE(s.x[j], lower[j]);
      ASSERT_LE(s.x[j], upper[j]);
    }
    ASSERT_NEAR(s.value, s.x.dot(g * s.x) - 2.0 * s.x.dot(b), 1e-8 * (1.0 + std::fabs(expected)));
  }
}

TEST(BoundedLeastSquares, ScalesOfColumnsDoNotMatter) {
  // A lobe of 10^6 beside a diffuse part of 0.1: the same solution in other units.
  SmallMatrix g(2, 2);
  g << 2.0, 0.5, 0.5, 1.0;
  SmallVector b(2);
  b << 1.0, 0.3;
  const SmallVector lower = SmallVector::Zero(2);
  SmallVector upper(2);
  upper << 0.4, 1.0;
  const BoundedSolution plain = solve_bounded(g, b, lower, upper);
  SmallVector unit(2);
  unit << 1e9, 1e-3;
  const BoundedSolution scaled = solve_bounded(SmallMatrix(unit.asDiagonal() * g * unit.asDiagonal()),
                                               unit.cwiseProduct(b), lower, SmallVector(upper.cwiseQuotient(unit)));
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(scaled.x[i] * unit[i], plain.x[i], 1e-14);
  EXPECT_EQ(plain.state[0], BoundState::at_upper);
}

TEST(BoundedLeastSquares, ZeroAndDependentColumnsAreLeftAtZero) {
  SmallMatrix g = SmallMatrix::Zero(3, 3);
  g(0, 0) = 4.0;
  g(0, 2) = g(2, 0) = 4.0;  // the third equals the first
  g(2, 2) = 4.0;
  SmallVector b(3);
  b << 2.0, 0.0, 2.0;
  const SmallVector lower = SmallVector::Zero(3);
  const SmallVector upper = SmallVector::Ones(3);
  const BoundedSolution s = solve_bounded(g, b, lower, upper);
  EXPECT_NEAR(s.x[0], 0.5, 1e-15);
  EXPECT_EQ(s.x[1], 0.0);
  EXPECT_EQ(s.x[2], 0.0);
}

}  // namespace
}  // namespace goniofit
