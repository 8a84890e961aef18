#pragma once
// A material as the renderer uses it: coh split off as a mirror, the rest evaluated in batches and drawn by the model's
// own sampling.

#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "../brdf/evaluator.h"
#include "../brdf/sampler.h"
#include "../geometry/direction_batch.h"
#include "scene.h"

namespace goniofit {

/// Directions in the material's frame, l to the light and v to the eye: f is always read as f(l, v), whichever of the
/// two was drawn, since not every model is reciprocal.
class MaterialShader {
 public:
  /// Values are those of `used`. What random numbers decide (drawn directions, which path ends) is of `given`: two
  /// renders of one scene then differ by their materials alone. Throws Error (bad_input) for a material that is not
  /// valid.
  MaterialShader(const Material& given, const RenderMaterial& used);

  [[nodiscard]] std::size_t channels() const noexcept { return used_.channels(); }
  /// Whether it reflects anything but a mirror's image, and whether it has that.
  [[nodiscard]] bool has_lobes() const noexcept { return lobes_.has_value(); }
  [[nodiscard]] bool has_mirror() const noexcept { return has_mirror_; }
  [[nodiscard]] bool follows() const noexcept { return follows_; }
  /// Whether `given` has both.
  [[nodiscard]] bool branches() const noexcept { return branches_; }

  /// result[channel * size + i] in 1/sr, without coh.
  struct Scratch {
    FloatDirectionBatch directions;
    std::vector<float> values;
  };
  void values(const DirectionBatch& directions, Scratch& scratch, std::vector<double>& result) const;

  /// l for a given v, drawn by the density of `given` without coh.
  [[nodiscard]] std::optional<DirectionSample> draw(const Direction& v, const std::array<double, 3>& u) const noexcept;
  /// Whether draw() would do so by a wide effect (all but dd and fs) for this first number.
  [[nodiscard]] bool draws_wide(const Direction& v, double u) const noexcept;
  [[nodiscard]] double pdf(const Direction& l, const Direction& v) const noexcept;

  /// Part of the light that comes from the mirror direction of v and leaves for v: k_dd F S exp(-g).
  [[nodiscard]] double mirror_weight(const Direction& v, std::size_t channel) const noexcept;
  /// With which chance a path goes on after the first few reflections: about the albedo of `given`.
  [[nodiscard]] double survival() const noexcept { return survival_; }

 private:
  struct Lobes {
    std::variant<BatchEvaluator<double>, BatchEvaluator<float>> evaluator;
  };
  Evaluator used_;
  bool has_mirror_, branches_, follows_;
  std::optional<Lobes> lobes_;
  std::optional<Sampler> sampler_;
  double survival_ = 0.0;
};

/// The material without coh; nullopt where nothing is left of it.
[[nodiscard]] std::optional<Material> without_mirror(const Material& material);

}  // namespace goniofit
