#include "batch_loop.h"

namespace goniofit::stability {

std::vector<BatchLoop> rough_limit_loops() { return batch_loop::dd_loops<DistributionTier::rough_limit>(); }

std::vector<BatchLoop> fs_loops() {
  std::vector<BatchLoop> loops;
  batch_loop::for_all_tiers([&]<ShadowingTier shadowing, EffectiveRoughnessTier roughness, bool anisotropic>() {
    if constexpr (shadowing == ShadowingTier::none) {
      const auto add = [&]<FsForm form>() {
        loops.push_back({{shadowing, roughness, DistributionTier::rough_limit, {.fs = form}, anisotropic},
                         &batch_loop::run<batch_loop::FsLoop<roughness, form, anisotropic>>});
      };
      add.template operator()<FsForm::printed>();
      add.template operator()<FsForm::reciprocal>();
    }
  });
  return loops;
}

}  // namespace goniofit::stability
