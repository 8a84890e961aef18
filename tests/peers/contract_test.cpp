// What every peer owes its callers, whatever the model.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "peer_support.h"
#include "support/error.h"

namespace goniofit {
namespace {

using test::between;

TEST(PeerContract, CatalogueAndFactoryAgree) {
  std::set<std::string_view> names;
  for (const PeerInfo& info : peer_catalogue()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " twice";
    EXPECT_FALSE(info.description.empty() || info.paper.empty()) << info.name;
    const auto basis = make_peer(info.name);
    ASSERT_NE(basis, nullptr) << info.name;
    std::set<std::size_t> used;
    for (const BasisColumn& column : basis->columns()) {
      ASSERT_LT(column.coefficient, basis->coefficients().size()) << info.name;
      used.insert(column.coefficient);
    }
    EXPECT_EQ(used.size(), basis->coefficients().size()) << info.name;
    for (const ShapeParameter& s : basis->shape_parameters()) {
      EXPECT_LT(s.origin, s.lower) << info.name << " " << s.name;
      EXPECT_LT(s.lower, s.upper) << info.name << " " << s.name;
      EXPECT_GT(s.step, 0.0) << info.name << " " << s.name;
    }
    EXPECT_FALSE(basis->has_length()) << info.name;
  }
  EXPECT_EQ(names.size(), 17U);
  EXPECT_EQ(make_peer("phong"), nullptr);
  EXPECT_EQ(make_peer(""), nullptr);
  EXPECT_THROW(static_cast<void>(make_peer("schlick-single", -1.0)), Error);
}

// Rows of arrays in the shape the batch overloads write.
struct Table {
  explicit Table(std::size_t rows, std::size_t pairs) : data(rows, std::vector<double>(pairs, -1.0)) {
    for (std::vector<double>& row : data) pointers.push_back(row.data());
  }
  std::vector<std::vector<double>> data;
  std::vector<double*> pointers;
};

PairBatch random_batch(std::mt19937_64& random, std::size_t n) {
  PairBatch batch;
  while (batch.size() < n) {
    const Pair p = make_pair(test::random_pair(random));
    if (p.cos_i > 0.0 && p.cos_r > 0.0) batch.push_back(p);
  }
  return batch;
}

class EveryPeer : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<const Basis> basis = make_peer(GetParam());
  std::size_t columns = basis->columns().size();
  std::size_t parameters = basis->shape_parameters().size();
};

// 10^5 pairs, half of them in corners, under 500 shapes, bounds included.
TEST_P(EveryPeer, IsFiniteAndNotNegativeAndItsOverloadsAgree) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 500; ++trial) {
    const PairBatch batch = random_batch(random, 200);
    std::vector<double> z = test::random_shape(*basis, random);
    for (std::size_t k = 0; k < parameters && trial < 64; ++k)
      z[k] = between(basis->shape_parameters()[k], (trial >> k) % 2 == 0 ? 0.0 : 1.0);
    Table values(columns, batch.size());
    Table dual_values(columns, batch.size());
    Table derivatives(columns * parameters, batch.size());
    basis->shape_factors(batch, z, 0.55, values.pointers);
    basis->shape_factors(batch, z, 0.55, dual_values.pointers, derivatives.pointers);
    std::vector<double> one(columns);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      basis->shape_factors(batch[i], z, 0.55, one);
      for (std::size_t j = 0; j < columns; ++j) {
        ASSERT_TRUE(std::isfinite(one[j]) && one[j] >= 0.0) << one[j] << " in column " << j;
        ASSERT_EQ(one[j], values.data[j][i]) << "column " << j;
        ASSERT_NEAR(one[j], dual_values.data[j][i], 1e-13 * one[j] * (1.0 + std::fabs(std::log(one[j] + 1e-300))));
        for (std::size_t k = 0; k < parameters; ++k) {
          const double derivative = derivatives.data[j * parameters + k][i];
          if (basis->columns()[j].reads_shape) {
            ASSERT_TRUE(std::isfinite(derivative)) << derivative << " in column " << j << " by parameter " << k;
          } else {
            ASSERT_EQ(derivative, -1.0) << "written though the column does not read the shape";
          }
        }
      }
    }
  }
}

// Five-point differences of the values; their own round-off where a lobe is about to vanish sets the 5e-8.
TEST_P(EveryPeer, DerivativesAreThoseOfTheValues) {
  if (parameters == 0) return;
  std::mt19937_64 random(12);
  std::size_t compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const PairBatch batch = random_batch(random, 20);
    const std::vector<double> z = test::random_shape(*basis, random);
    Table values(columns, batch.size());
    Table derivatives(columns * parameters, batch.size());
    basis->shape_factors(batch, z, 0.55, values.pointers, derivatives.pointers);
    for (std::size_t k = 0; k < parameters; ++k) {
      // Schlick's blend changes sides at r = ½, with a step in its second derivative.
      if (basis->shape_parameters()[k].name.front() == 'r' && std::fabs(z[k] - std::log(0.5)) < 0.01) continue;
      constexpr double h = 1e-3;
      std::vector<Table> at;
      for (const double step : {-2.0 * h, -h, h, 2.0 * h}) {
        std::vector<double> moved = z;
        moved[k] += step;
        at.emplace_back(columns, batch.size());
        basis->shape_factors(batch, moved, 0.55, at.back().pointers);
      }
      for (std::size_t j = 0; j < columns; ++j) {
        if (!basis->columns()[j].reads_shape) continue;
        for (std::size_t i = 0; i < batch.size(); ++i) {
          const double f = values.data[j][i];
          const double ours = derivatives.data[j * parameters + k][i];
          const double steepness = std::fabs(ours) / (f + 1e-300);
          if (f < 1e-100 || steepness > 20.0) continue;
          const double theirs =
              (at[0].data[j][i] - 8.0 * at[1].data[j][i] + 8.0 * at[2].data[j][i] - at[3].data[j][i]) / (12.0 * h);
          EXPECT_NEAR(ours, theirs, f * (5e-8 + 1e-11 * std::pow(1.0 + steepness, 5.0)))
              << "column " << j << " by " << basis->shape_parameters()[k].name << " at " << z[k];
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000U);
}

TEST_P(EveryPeer, IsReciprocalOutsideTheMirrorCone) {
  std::mt19937_64 random(13);
  const auto bare = make_peer(GetParam(), 0.0);
  const ChannelOptics glass = ChannelOptics::of_index(1.5, 0.0);
  const std::vector<double> k = test::unit_coefficients(*bare);
  for (int trial = 0; trial < 20000; ++trial) {
    const AnglePair a = test::random_pair(random);
    const Pair there = make_pair(a);
    const Pair back = make_pair(swapped(a));
    if (there.cos_i <= 0.0 || there.cos_r <= 0.0) continue;
    const std::vector<double> z = test::random_shape(*bare, random);
    const double f = test::value(*bare, there, z, k, glass, FresnelTier::exact);
    const double g = test::value(*bare, back, z, k, glass, FresnelTier::exact);
    ASSERT_NEAR(f, g, 1e-9 * f) << a.theta_i_deg << " " << a.theta_r_deg << " " << a.phi_r_deg - a.phi_i_deg;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const PeerInfo& info : peer_catalogue()) out.emplace_back(info.name);
  return out;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Peers, EveryPeer, ::testing::ValuesIn(names()), test_name);

}  // namespace
}  // namespace goniofit
