#include "fit/order_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "fit/dot.h"
#include "support/radix_sort.h"

namespace goniofit {
namespace {

// Even ones, such as lie in a few huge ones' shadow, ties, and values sorted already.
std::vector<std::vector<double>> samples(std::size_t n) {
  std::mt19937_64 bits(5);
  std::lognormal_distribution<double> wide(0.0, 4.0);
  std::vector<std::vector<double>> out(3);
  for (std::size_t i = 0; i < n; ++i) {
    out[0].push_back(wide(bits));
    out[1].push_back(static_cast<double>(bits() % 3));
    out[2].push_back(static_cast<double>(i));
  }
  return out;
}

TEST(OrderStatistics, AreThoseOfSorting) {
  for (const std::size_t n : {1U, 7U, 1019U, 1021U, 20011U}) {
    for (const std::vector<double>& sample : samples(n)) {
      std::vector<double> sorted = sample;
      std::sort(sorted.begin(), sorted.end());
      for (const std::size_t rank : {std::size_t{0}, n / 4, n / 2, n - 1}) {
        std::vector<double> values = sample;
        EXPECT_EQ(value_at_rank(values, rank), sorted[rank]) << n << ' ' << rank;
      }
    }
  }
}

TEST(OrderStatistics, TheLargestThatHoldNineTenths) {
  for (const std::size_t n : {1U, 7U, 1000U, 20011U}) {
    for (const std::vector<double>& sample : samples(n)) {
      std::vector<double> sorted = sample;
      std::sort(sorted.begin(), sorted.end(), std::greater<>());
      double total = 0.0;
      for (const double v : sorted) total += v;
      std::size_t expected = 0;
      for (double sum = 0.0; expected < n && sum < 0.9 * total;) sum += sorted[expected++];
      std::vector<double> values = sample;
      EXPECT_NEAR(static_cast<double>(count_of_largest(values, 0.9)), static_cast<double>(expected), 1.0) << n;
    }
  }
  std::vector<double> dark(5, 0.0);
  EXPECT_EQ(count_of_largest(dark, 0.9), 0U);
}

TEST(RadixSort, KeepsTheOrderOfEqualKeys) {
  std::mt19937_64 bits(2);
  std::vector<KeyedRow> rows;
  for (std::size_t i = 0; i < 5000; ++i) rows.push_back({i % 2 == 0 ? bits() : bits() % 16, i});
  std::vector<KeyedRow> expected = rows;
  std::stable_sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  radix_sort(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(rows[i].row, expected[i].row) << i;
  std::vector<KeyedRow> none;
  radix_sort(none);
  EXPECT_TRUE(none.empty());
}

TEST(RadixSort, SizesKeepTheirOrderAsKeys) {
  EXPECT_LT(key_of_size(0.0), key_of_size(1e-310));
  EXPECT_LT(key_of_size(1e-310), key_of_size(0.5));
  EXPECT_LT(key_of_size(0.5), key_of_size(1e300));
}

TEST(Products, AreDotProducts) {
  for (const std::size_t n : {0U, 31U, 513U, 2000U}) {
    std::mt19937_64 bits(9);
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> columns(3, std::vector<double>(n));
    std::vector<const double*> pointers;
    for (std::vector<double>& c : columns) {
      for (double& x : c) x = normal(bits);
      pointers.push_back(c.data());
    }
    std::vector<double> all(6, 1.0);
    std::vector<double> with(3, 1.0);
    add_products(pointers.data(), 3, n, all.data());
    add_products_with(pointers.data(), 3, pointers[1], n, with.data());
    std::vector<double> weighted(6, 1.0);
    std::vector<double> product(n);
    add_weighted_products(pointers.data(), 3, pointers[2], n, weighted.data());
    for (std::size_t b = 0, k = 0; b < 3; ++b) {
      multiply(pointers[b], pointers[2], product.data(), n);
      for (std::size_t a = 0; a <= b; ++a, ++k)
        EXPECT_NEAR(weighted[k], 1.0 + dot(pointers[a], product.data(), n), 1e-10);
    }
    const std::vector<double> matrix{1.0, 2.0, -1.0, 0.5, 0.0, 3.0};  // 3 x 2
    std::vector<double> norms(n, 1.0);
    add_squared_norms(pointers.data(), 3, matrix.data(), 2, n, norms.data());
    for (std::size_t b = 0, k = 0; b < 3; ++b) {
      EXPECT_NEAR(with[b], 1.0 + dot(pointers[b], pointers[1], n), 1e-10);
      for (std::size_t a = 0; a <= b; ++a, ++k) EXPECT_NEAR(all[k], 1.0 + dot(pointers[a], pointers[b], n), 1e-10);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double first = columns[0][i] + 2.0 * columns[1][i] - columns[2][i];
      const double second = 0.5 * columns[0][i] + 3.0 * columns[2][i];
      EXPECT_NEAR(norms[i], 1.0 + first * first + second * second, 1e-12 * norms[i]);
    }
  }
}

}  // namespace
}  // namespace goniofit
