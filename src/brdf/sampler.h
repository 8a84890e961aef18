#pragma once
// Importance sampling of the whole reflectance model, for which Li & Torrance 2005 give none.
//
// An effect is chosen by its albedo at the incidence angle (the mean over channels, so that one sample serves them
// all), then a direction by that effect's lobe: coh uniformly in its mirror cone, dd at the visible normals, fs about
// forward grazing, udf, uds and all else by the cosine. What the tiers do to the width of a lobe (effective roughness,
// wave optics, a long tail, shadowing) has no closed form; therefore it is measured: construction evaluates the
// material itself, picks for each of the tabulated incidences the width whose weights vary least, and tabulates the
// albedos. Tables decide the variance only; pdf() is exactly the density that sample() draws from. A peer model is
// sampled the same way, as facets (dd) above a diffuse level (udf): its density is as exact, its weights are as even as
// its lobe is like that of facets (Schlick's lobes are not: peers/schlick_sampling.h).
//
// Measured up to 85°, relative to the albedo: the variance of the weights is 0.002 to 0.09 on three of Li & Torrance's
// samples and at most 0.33 on their paint (whose channels differ); no weight is above 2.3. Worse: a smooth metal beyond
// 88° (276 at 89.5° on theirs), and slopes with a tail of 1.1 at grazing, where 5 % of the weights pass 4.

#include <array>
#include <optional>

#include "../geometry/direction.h"
#include "evaluator.h"
#include "sampling_lobes.h"
#include "sampling_rows.h"

namespace goniofit {

struct DirectionSample {
  Direction direction;  ///< V
  double pdf;           ///< per steradian, of all effects together; > 0
  Effect chosen;        ///< whose lobe drew it: dd or udf of a peer, udf where nothing is reflected
};

class Sampler {
 public:
  /// Evaluates the material some 4e4 times (10 to 40 ms); keeps no reference to it.
  explicit Sampler(const Evaluator& evaluator);

  /// V for a light from l and three independent numbers uniform in [0, 1). Null when V falls below the horizon: the ray
  /// is absorbed, its weight is 0 (the pdf then integrates to less than 1). Null too where l does. The weight of a
  /// sample is f cos(theta_r) / pdf.
  [[nodiscard]] std::optional<DirectionSample> sample(const Direction& l,
                                                      const std::array<double, 3>& u) const noexcept;

  /// The effect that sample() draws by for u[0], at a tenth of its cost: for callers who would not use them all. udf
  /// where l is below the horizon.
  [[nodiscard]] Effect chosen(const Direction& l, double u) const noexcept;

  /// Density of V per steradian for a light from l; 0 where l or v is below the horizon.
  [[nodiscard]] double pdf(const Direction& l, const Direction& v) const noexcept;

 private:
  /// The lobes for one l.
  struct Mixture {
    EffectShares share;
    ConeLobe cone;
    FacetLobe facets;
    ForwardLobe forward;
  };
  [[nodiscard]] Mixture mixture(const Direction& l) const noexcept;
  [[nodiscard]] static double density(const Mixture& m, const Direction& l, const Direction& v) noexcept;

  NominalLobes nominal_;
  SamplingRows rows_;
};

}  // namespace goniofit
