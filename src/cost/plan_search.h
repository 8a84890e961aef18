#pragma once
// All combinations of effects and tiers, and their errors. Private to the planner.

#include <map>
#include <tuple>
#include <vector>

#include "candidate.h"
#include "model_error.h"
#include "planner.h"

namespace goniofit {

/// What a plan chooses.
struct PlanChoice {
  EffectSet effects;
  Terms terms;
  RoughForm rough = RoughForm::functional;
  friend bool operator==(const PlanChoice&, const PlanChoice&) = default;
};

/// Whether effects read a term at all.
[[nodiscard]] bool reads_fresnel(EffectSet effects) noexcept;
[[nodiscard]] bool reads_shadowing(EffectSet effects) noexcept;
[[nodiscard]] bool reads_effective_roughness(EffectSet effects) noexcept;
[[nodiscard]] bool reads_distribution(EffectSet effects) noexcept;

class PlanSearch {
 public:
  /// `reference` has the most exact terms; `given` are the terms that what is not read falls back to.
  /// Keeps a reference to the samples.
  PlanSearch(Material reference, const Terms& given, const PlanSamples& samples, const PlanSettings& settings);

  PlanSearch(const PlanSearch&) = delete;
  PlanSearch& operator=(const PlanSearch&) = delete;
  PlanSearch(PlanSearch&&) = delete;
  PlanSearch& operator=(PlanSearch&&) = delete;
  ~PlanSearch() = default;

  /// Why an effect stays whatever its error; null where it need not.
  [[nodiscard]] const std::string* reason_to_keep(Effect effect) const noexcept;
  /// The reference's tiers first, the cheaper ones after.
  [[nodiscard]] const std::vector<FresnelTier>& fresnel() const noexcept { return fresnel_; }
  [[nodiscard]] const std::vector<ShadowingTier>& shadowing() const noexcept { return shadowing_; }
  [[nodiscard]] const std::vector<EffectiveRoughnessTier>& roughness() const noexcept { return roughness_; }
  [[nodiscard]] const std::vector<DistributionTier>& distribution() const noexcept { return distribution_; }
  [[nodiscard]] const std::vector<RoughForm>& rough() const noexcept { return rough_; }

  [[nodiscard]] PlanChoice reference() const;
  /// Terms that the effects do not read as given: every choice that evaluates alike is one.
  [[nodiscard]] PlanChoice canonical(PlanChoice choice) const;
  [[nodiscard]] std::vector<PlanChoice> all() const;
  [[nodiscard]] ModelError error(const PlanChoice& choice);
  [[nodiscard]] Material material(const PlanChoice& choice) const;

 private:
  using Key = std::tuple<Effect, FresnelTier, ShadowingTier, EffectiveRoughnessTier, DistributionTier, RoughForm>;
  [[nodiscard]] const ModelValues& part(Effect effect, const PlanChoice& choice);
  [[nodiscard]] ModelValues sum(const PlanChoice& choice);

  Material reference_;
  Terms given_;
  CompileSettings compile_;
  Arithmetic arithmetic_;
  EffectSet acting_;
  const PlanSamples& samples_;
  std::vector<FresnelTier> fresnel_;
  std::vector<ShadowingTier> shadowing_;
  std::vector<EffectiveRoughnessTier> roughness_;
  std::vector<DistributionTier> distribution_;
  std::vector<RoughForm> rough_;
  std::map<Key, ModelValues> parts_;  ///< f is the sum over effects: each is evaluated once for each of its tiers
  ModelValues exact_;
};

/// All but the empty one.
[[nodiscard]] std::vector<EffectSet> subsets_of(EffectSet effects);

/// What a choice usually costs, in ns a channel: a sum over its effects and the terms that they read.
[[nodiscard]] double usual_ns(const PlanChoice& choice) noexcept;

/// Whether `a` should be no dearer than `b`: no more effects, and each term that it reads the same, left out,
/// or plainly a part of the other's work.
[[nodiscard]] bool no_dearer(const PlanChoice& a, const PlanChoice& b) noexcept;

}  // namespace goniofit
