#pragma once
// Scenes to pictures: direct light from all lights, by drawing lights and by the model's own sampling, and paths of
// further reflections. Tiles of a fixed size and order, one thread at a time each: the picture does not depend on the
// threads.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "path_observer.h"
#include "scene.h"

namespace goniofit {

/// How lights that have a size are found: both ways, weighted by their densities (the balance heuristic of Veach &
/// Guibas 1995), or one alone, which has the same mean.
enum class LightSampling : std::uint8_t { both, lights, model };

struct RenderSettings {
  std::size_t threads = 0;  ///< 0: as many as the machine has
  LightSampling sampling = LightSampling::both;
  PathObserver* observer = nullptr;  ///< told of every path; on one thread then, whatever `threads` says
};

struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<SceneChannel> channels;
  std::vector<double> radiance;  ///< [(row * width + column) * channels + channel], rows from the top; W/(m² sr)
};

/// What was done, and the seconds of processor time that it took, of all threads together.
struct RenderWork {
  std::uint64_t camera_rays = 0, path_rays = 0, mirror_rays = 0, shadow_rays = 0;
  std::uint64_t evaluations = 0;  ///< of the reflectance for a pair of directions, all channels at once
  double trace_s = 0.0, evaluate_s = 0.0, draw_s = 0.0, other_s = 0.0;
  RenderWork& operator+=(const RenderWork& other) noexcept;
};

struct Rendering {
  Picture picture;
  RenderWork work;
  double seconds = 0.0;            ///< of the clock, from the first ray to the last
  double preparation_s = 0.0;      ///< materials compiled, samplers measured, the scene built
  std::vector<std::string> notes;  ///< what the picture leaves out, in sentences
};

/// Told how many tiles of all are done, one call at a time.
using RenderProgress = std::function<void(std::size_t done, std::size_t total)>;

/// `materials` are those of the scene in its order, or what shall be used instead: random numbers do not depend on
/// them. Throws Error: bad_input where the scene is not valid or there are not as many materials, system where Embree
/// fails.
[[nodiscard]] Rendering render(const Scene& scene, std::span<const RenderMaterial> materials,
                               const RenderSettings& settings = {}, const RenderProgress& progress = {});

}  // namespace goniofit
