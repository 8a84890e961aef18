#pragma once
// A material made ready for evaluation.

#include <cstddef>
#include <memory>
#include <vector>

#include "../geometry/pair.h"
#include "material.h"

namespace goniofit {

/// A value beyond this is returned as this: the one documented saturation (the dd lobe of a smooth surface exceeds it
/// in the mirror direction at extreme grazing).
inline constexpr double saturation = 1e300;

class Basis;

class Evaluator {
 public:
  /// Throws Error (bad_input) when the material is not valid.
  explicit Evaluator(Material material);

  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] std::size_t channels() const noexcept { return material_.channels.size(); }

  /// BRDF in 1/sr of one channel; 0 outside the hemisphere, never negative, never NaN, at most `saturation`.
  [[nodiscard]] double value(const Pair& pair, std::size_t channel) const noexcept;
  /// One effect's part of it (coh or dd each take the whole k_dd); 0 for a peer model, which has no effects.
  [[nodiscard]] double value(const Pair& pair, std::size_t channel, Effect effect) const noexcept;
  /// Values of all channels at all pairs: result[pair * channels() + channel]. The scalar reference, one by one.
  [[nodiscard]] std::vector<double> values(const PairBatch& pairs) const;

  /// Whether Oren and Nayar's functional form is negative here and was cut at zero (forward grazing, from a facet slope
  /// of some 40°).
  [[nodiscard]] bool cut_at_zero(const Pair& pair) const noexcept;

 private:
  [[nodiscard]] double peer_value(const Pair& pair, const MaterialChannel& channel) const noexcept;

  Material material_;
  std::shared_ptr<const Basis> peer_;  ///< null for the surface family
  std::vector<double> peer_shape_;
};

/// Directional-hemispherical reflectance at theta_i: the integral of f cos(theta_r) over the hemisphere, all channels.
/// Relative accuracy about 1e-4 up to 85 degrees (1.5 % for slopes of 0.4 and more without shadowing, whose lobe ends
/// at the horizon; 1e-3 for an anisotropic surface, which is lit along its x axis).
[[nodiscard]] std::vector<double> hemispherical_reflectance(const Evaluator& evaluator, double theta_i_deg);

}  // namespace goniofit
