#pragma once
// What a choice of effects must not leave out.

#include <cstddef>
#include <vector>

#include "selection_candidate.h"

namespace goniofit {

/// The effects of a set whose coefficient is at least five of its standard uncertainties (HC3, in the fit as asked).
class StandingEffects {
 public:
  explicit StandingEffects(const Candidate& candidate);

  /// Whether another set lacks one of them although this one has the smaller AICc: of two sets that describe the
  /// readings in different ways, none within the other, each leaves out what the other calls significant, and the
  /// readings have to say which is right. A set that describes all that the other does (grooves: udf too) needs a chi²
  /// smaller by 25 besides. coh, without a coefficient of its own, stands where the other's chi² is
  /// larger by 25.
  [[nodiscard]] bool refuse(const Candidate& other) const;
  /// By channel.
  [[nodiscard]] bool stands(Effect effect, std::size_t channel) const { return stands_[channel].has(effect); }

 private:
  [[nodiscard]] bool stands_anywhere(Effect effect) const;
  const Candidate& candidate_;
  std::vector<EffectSet> stands_;  ///< one a channel
};

}  // namespace goniofit
