// Every peer through the same machinery: its own scans come back, whatever the number of its shape parameters.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "fit/fit.h"
#include "fit/polish.h"
#include "peers/peers.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

// A material of the model, drawn from where lobes are neither flat nor narrower than the sampling resolves.
Material drawn(const std::string& model, std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto decades = [&](double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); };
  Material m;
  m.name = model;
  m.model = model;
  const auto basis = make_peer(model);
  double exponent = 5.0;
  for (const ShapeParameter& p : basis->shape_parameters()) {
    double value = decades(0.05, 0.5);                                           // widths
    if (p.name.starts_with("exponent")) value = exponent *= decades(4.0, 10.0);  // lobes that differ
    if (p.name.starts_with("normal_to_grazing")) value = decades(0.2, 5.0);
    if (p.name.starts_with("r")) value = decades(0.01, 0.3);
    if (p.name.starts_with("p")) value = decades(0.1, 0.8);
    m.parameters[p.name] = value;
  }
  m.channels = {test::channel("R", 0.65, 1.5, 0, 0, 0, 0, 0), test::channel("G", 0.55, 1.6, 0, 0, 0, 0, 0)};
  for (MaterialChannel& c : m.channels) {
    c.k = {};
    for (const BasisCoefficient& k : basis->coefficients()) {
      if (!k.constant()) c.set_coefficient(k.name, uniform(0.1, 0.8));
    }
  }
  return m;
}

FitSettings settings_of(const Material& m) {
  FitSettings s;
  s.model = m.model;
  s.n = {1.5, 1.6};
  return s;
}

class EveryPeerFit : public testing::TestWithParam<std::string> {};

TEST_P(EveryPeerFit, RecoversItsOwnScans) {
  std::mt19937_64 random(4);
  const bool many = make_peer(GetParam())->shape_parameters().size() > 3;
  for (int trial = 0; trial < (many ? 1 : 3); ++trial) {
    const Material m = drawn(GetParam(), random);
    const Scan scan = simulate(m, Sampling::hemisphere, {0.0, 0.0}, 1);
    const FitResult r = fit(scan, settings_of(m));
    EXPECT_TRUE(r.converged);
    double total = 0.0;
    for (const ScanChannel& c : scan.channels) {
      for (const double value : c.values) total += value * value;
    }
    EXPECT_LT(r.loss, 1e-16 * total) << "trial " << trial;
  }
}

TEST_P(EveryPeerFit, EndsNowhereWorseThanTheTruthUnderNoise) {
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 4; ++trial) {
    const Material m = drawn(GetParam(), random);
    const Scan scan = simulate(m, Sampling::incidence_plane, {0.02, 0.0}, static_cast<std::uint64_t>(trial));
    const double reachable = polish_from(scan, settings_of(m), m).loss;
    EXPECT_LE(fit(scan, settings_of(m)).loss, reachable * (1.0 + 1e-6)) << "trial " << trial;
  }
}

std::vector<std::string> models() {
  std::vector<std::string> names;
  for (const PeerInfo& info : peer_catalogue()) names.emplace_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryPeerFit, testing::ValuesIn(models()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace goniofit
