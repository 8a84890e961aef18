// What the tiers beyond the published ones buy on real surfaces: long tails on coatings, grooves on plaster.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "fit/fit.h"
#include "io/scan_reader.h"
#include "support/paths.h"

namespace goniofit {
namespace {

Scan read(const std::string& file, const std::vector<std::string>& channels = {}) {
  Scan scan = read_scan(*test::shared_data() / "measured" / file);
  return channels.empty() ? scan : select_channels(scan, channels);
}

// n free, as it has to be where nobody measured it.
FitSettings free_index() {
  FitSettings s;
  s.free_optics = FreeOptics::n;
  return s;
}

double peer_loss(const Scan& scan, const std::string& model) {
  FitSettings s = free_index();
  s.model = model;
  return fit(scan, s).loss;
}

// Every set of the smooth surface's effects that has a directional part, or none.
double best_smooth_loss(const Scan& scan, DistributionTier distribution, const FitSettings& from) {
  double best = std::numeric_limits<double>::infinity();
  constexpr std::array effects{Effect::dd, Effect::udf, Effect::uds, Effect::fs};
  for (unsigned bits = 1; bits < 16; ++bits) {
    FitSettings s = from;
    s.terms.distribution = distribution;
    s.components = EffectSet{};
    for (std::size_t i = 0; i < effects.size(); ++i) {
      if ((bits >> i & 1U) != 0) s.components->insert(effects[i]);
    }
    best = std::min(best, fit(scan, s).loss);
  }
  return best;
}

TEST(RealSurfaces, ALongTailBeatsGgxAndCookTorranceOnCoatings) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  const std::array scans{read("krylon_blue.csv", {"450nm", "550nm", "650nm"}), read("black_anodise_ec1.csv")};
  for (const Scan& scan : scans) {
    const double peers = std::min(peer_loss(scan, "ggx"), peer_loss(scan, "cook-torrance"));
    const double tailed = best_smooth_loss(scan, DistributionTier::student_t, free_index());
    EXPECT_LE(tailed, 0.85 * peers) << scan.source;
    EXPECT_LT(tailed, best_smooth_loss(scan, DistributionTier::rough_limit, free_index())) << scan.source;
  }
}

TEST(RealSurfaces, GroovesBeatEverySmoothSurfaceOnPlaster) {
  GONIOFIT_SKIP_WITHOUT_SHARED_DATA();
  for (const char* file : {"curet_10.csv", "curet_45.csv", "curet_50.csv"}) {
    const Scan scan = read(file);
    const double smooth = best_smooth_loss(scan, DistributionTier::rough_limit, {});
    for (const RoughForm form : {RoughForm::functional, RoughForm::qualitative, RoughForm::integral}) {
      FitSettings s;
      s.components = EffectSet{Effect::rough};
      s.forms.rough = form;
      const FitResult r = fit(scan, s);
      EXPECT_TRUE(r.converged) << file;
      EXPECT_LT(r.loss, smooth / 5.0) << file << " " << name_of(form);
      ASSERT_TRUE(r.material.surface.facet_slope_deg);
      EXPECT_NEAR(*r.material.surface.facet_slope_deg, 29.0, 10.0) << file << " " << name_of(form);
    }
  }
}

}  // namespace
}  // namespace goniofit
