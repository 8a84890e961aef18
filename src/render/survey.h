#pragma once
// What a scene asks of its materials: at which pairs of directions each is needed, and what an error there does to the
// image. Found by a small render of the scene with every light path written down.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../geometry/direction_batch.h"
#include "../geometry/domain.h"
#include "scene.h"

namespace goniofit {

struct SurveySettings {
  std::size_t pixels = 4096;          ///< about as many, in the image's shape
  std::size_t samples = 4;            ///< a pixel
  std::size_t most_vertices = 32768;  ///< kept of a material: whole pixels are dropped at random beyond
  std::uint64_t seed = 1;
};

/// A factor of light paths: to first order an error Δ of it changes the radiance of `pixel` by weight * Δ in each
/// channel.
struct PathFactors {
  DirectionBatch directions{};
  std::vector<std::uint32_t> pixel{};
  std::vector<double> weights{};  ///< [channel * size + i]
  [[nodiscard]] std::size_t size() const noexcept { return pixel.size(); }
};

/// A light with a size, other than the sky, whose mirror image in the material is in view or may lie between the pixels
/// of the survey.
struct MirrorImage {
  std::size_t light;
  std::uint32_t pixel;  ///< nearest to it
  Direction v;          ///< to the eye from there
};

struct MaterialSurvey {
  bool seen = false;      ///< some light path that matters has it
  Domain domain{};        ///< the zenith angles of light and viewer that occur
  PathFactors lobes{};    ///< values f of all effects but coh
  PathFactors mirrors{};  ///< what coh reflects, k_dd F S exp(-g), at l = mirrored(v)
  std::vector<MirrorImage> images{};
  /// What of each pixel's radiance leaves the material at some point of its path, and what of that came to it by way of
  /// other surfaces: [pixel * channels + channel].
  std::vector<double> sent{}, from_surfaces{};
};

struct SceneSurvey {
  std::size_t width = 0, height = 0;
  std::uint64_t seed = 0;        ///< of the small picture
  std::vector<double> radiance;  ///< [pixel * channels + channel]
  std::vector<MaterialSurvey> materials;
};

/// With these materials in place of the scene's. Errors: those of render().
[[nodiscard]] SceneSurvey survey(const Scene& scene, std::span<const RenderMaterial> materials,
                                 const SurveySettings& settings = {});

/// The scene with an image of about so many pixels.
[[nodiscard]] Scene in_small(const Scene& scene, std::size_t pixels, std::size_t samples, std::uint64_t seed);

}  // namespace goniofit
