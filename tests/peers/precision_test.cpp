// Each formula against itself at 50 digits, from the same double-precision geometry: round-off of the formula alone.

#include <gtest/gtest.h>

#include "peer_support.h"
#include "peers/blinn_phong.h"
#include "peers/cook_torrance.h"
#include "peers/ggx.h"
#include "peers/lafortune.h"
#include "peers/neumann_neumann.h"
#include "peers/schlick.h"
#include "peers/ward.h"

namespace goniofit {
namespace {

using test::Big;

// Largest |f - truth|/f over (1 + |ln f|): an exponential of -500 rightly loses a factor of 500. Values below 1e-100
// are left out.
template <class Model>
double worst_round_off(std::string_view name) {
  const auto basis = make_peer(name);
  std::mt19937_64 random(21);
  double worst = 0.0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Pair p = make_pair(test::random_pair(random));
    if (p.cos_i <= 0.0 || p.cos_r <= 0.0) continue;
    const std::vector<double> z = test::random_shape(*basis, random);
    const std::vector<Big> wide_z(z.begin(), z.end());
    std::array<double, Model::columns> f;
    std::array<Big, Model::columns> truth;
    Model::factors(p, z.data(), f.data());
    Model::factors(test::wide(p), wide_z.data(), truth.data());
    for (std::size_t j = 0; j < f.size(); ++j) {
      if (truth[j] < Big("1e-100")) continue;
      const double error = std::fabs(static_cast<double>((f[j] - truth[j]) / truth[j]));
      worst = std::max(worst, error / (1.0 + std::fabs(static_cast<double>(log(truth[j])))));
    }
  }
  std::printf("%-24s %.1e\n", std::string(name).c_str(), worst);
  return worst;
}

TEST(PeerPrecision, DoubleAgreesWithFiftyDigits) {
  EXPECT_LT(worst_round_off<BlinnPhong>("blinn-phong"), 2e-15);
  EXPECT_LT(worst_round_off<NeumannNeumann>("neumann-neumann"), 2e-15);
  EXPECT_LT(worst_round_off<Ward>("ward"), 2e-15);
  EXPECT_LT(worst_round_off<WardAnisotropic>("ward-anisotropic"), 2e-15);
  EXPECT_LT(worst_round_off<CookTorrance>("cook-torrance"), 2e-15);
  EXPECT_LT(worst_round_off<Ggx>("ggx"), 2e-15);
  EXPECT_LT(worst_round_off<GgxAnisotropic>("ggx-anisotropic"), 2e-15);
  EXPECT_LT(worst_round_off<SchlickSingle<SchlickAzimuth::normalised>>("schlick-single"), 2e-15);
  EXPECT_LT(worst_round_off<SchlickSingle<SchlickAzimuth::printed>>("schlick-single-printed"), 2e-15);
  EXPECT_LT(worst_round_off<SchlickDouble<SchlickAzimuth::isotropic>>("schlick-double-isotropic"), 2e-15);
  // Its bracket is a difference on the retro side.
  EXPECT_LT(worst_round_off<Lafortune<3>>("lafortune-3"), 2e-14);
}

}  // namespace
}  // namespace goniofit
