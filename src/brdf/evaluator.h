#pragma once
// A material made ready for evaluation.

#include <cstddef>
#include <vector>

#include "../geometry/pair.h"
#include "material.h"

namespace goniofit {

/// A value beyond this is returned as this: the one documented saturation (the dd lobe of a smooth surface exceeds it
/// in the mirror direction at extreme grazing).
inline constexpr double saturation = 1e300;

class Evaluator {
 public:
  /// Throws Error (bad_input) when the material is not valid.
  explicit Evaluator(Material material);

  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] std::size_t channels() const noexcept { return material_.channels.size(); }

  /// BRDF in 1/sr of one channel; 0 outside the hemisphere, never negative, never NaN, at most `saturation`.
  [[nodiscard]] double value(const Pair& pair, std::size_t channel) const noexcept;
  /// One effect's part of it (coh or dd each take the whole k_dd).
  [[nodiscard]] double value(const Pair& pair, std::size_t channel, Effect effect) const noexcept;
  /// Values of all channels at all pairs: result[pair * channels() + channel]. The scalar reference, one by one.
  [[nodiscard]] std::vector<double> values(const PairBatch& pairs) const;

 private:
  Material material_;
};

/// Directional-hemispherical reflectance at theta_i: the integral of f cos(theta_r) over the hemisphere, all channels.
/// The coherent part is added by its energy, k_dd F S exp(-g). Relative accuracy about 1e-4 up to 85 degrees.
[[nodiscard]] std::vector<double> hemispherical_reflectance(const Evaluator& evaluator, double theta_i_deg);

}  // namespace goniofit
