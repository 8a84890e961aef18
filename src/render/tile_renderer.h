#pragma once
// The paths of one tile, all of a bounce at a time: rays are traced together, hits grouped by material, and each
// material evaluated for all its hits at once. Private to the renderer.

#include "clear_views.h"
#include "light_sampler.h"
#include "material_shader.h"
#include "renderer.h"
#include "tracer.h"

namespace goniofit {

/// What all tiles share.
struct RenderContext {
  const Scene& scene;
  const Tracer& tracer;
  const std::vector<LightSampler>& lights;
  const ClearViews& clear_views;
  const std::vector<MaterialShader>& materials;
  LightSampling sampling;
  PathObserver* observer;  ///< null: nobody listens
  Frame camera;            ///< x to the right, y up, z back

  [[nodiscard]] std::size_t channels() const noexcept { return scene.channels.size(); }
};

struct Tile {
  std::size_t left, top, right, bottom;  ///< right and bottom lie outside
};

class TileRenderer {
 public:
  explicit TileRenderer(const RenderContext& context);
  /// Adds the radiances of the tile's pixels, each the mean of its samples.
  void render(const Tile& tile, std::span<double> radiance);
  [[nodiscard]] const RenderWork& work() const noexcept { return work_; }

 private:
  // A path's last stretch, and what weighs the light that it meets.
  struct Path {
    std::size_t pixel;
    std::uint64_t key;  // of its random numbers: pixel and which branch of reflections it is
    std::uint32_t sample;
    Vec3 normal;                 // of the surface that it left
    double pdf = 0.0;            // of its direction by the model's sampling; 0 for the camera's and mirrors' rays
    double light_chance = 1.0;   // with which that surface drew each light
    bool drawn = false;          // whether any of its directions was drawn, not the camera's or a mirror's
    bool lights_only = false;    // surfaces that it meets are not asked
    std::uint32_t observed = 0;  // the observer's name of it
  };
  struct Paths {
    std::vector<Ray> rays;
    std::vector<Path> paths;
    std::vector<double> throughput;  // [path * channels + channel]
    void clear() {
      rays.clear();
      paths.clear();
      throughput.clear();
    }
    [[nodiscard]] std::size_t size() const noexcept { return rays.size(); }
  };
  // Light that may reach a hit.
  struct Arrival {
    std::uint32_t path;
    double weight;  // scale, cosine and all but f and the light's spectrum
    const double* spectrum;
  };

  void find_discs(const Tile& tile);
  void start_paths(const Tile& tile, std::size_t first_sample, std::size_t samples);
  void trace();
  void collect_emission(int bounce);
  [[nodiscard]] Vec3 camera_direction(double column, double row) const;
  void add_emission(std::size_t path, const LightSampler::Emission& emission, double weight);
  // sums_; returns what part of them the limit of a path leaves.
  double add(const Path& path, double* pixel) {
    const double scale = path.drawn && context_.scene.image.path_limit ? part_within_limit() : 1.0;
    for (std::size_t c = 0; c < channels_; ++c) pixel[c] += scale * sums_[c];
    return scale;
  }
  [[nodiscard]] double part_within_limit() const;
  void find_surfaces();
  void light_directly(std::size_t material, int bounce);
  void draw_light(std::size_t material, std::size_t light, double chance, const std::vector<std::uint32_t>& hits);
  void add_arrivals(std::size_t material, std::size_t light, bool coherent);
  void tell_of_arrivals(std::size_t material, std::size_t light, std::size_t count);
  void go_on(std::size_t material, int bounce);
  void reflect_in_mirror(std::size_t material, std::uint32_t path, double chance);
  void reflect_by_model(const MaterialShader& shader, std::uint32_t path, int bounce, double chance);
  void add_reflected(std::size_t material);
  [[nodiscard]] PathVertex vertex(std::uint32_t path, std::size_t material, const Direction& l) const;
  void lap(double RenderWork::*phase);

  const RenderContext& context_;
  std::size_t channels_;
  double pixel_size_;  // at a distance of 1
  bool sized_lights_ = false, mirrored_lights_ = false;
  Paths now_, next_;
  std::vector<std::size_t> skies_, discs_,
      discs_in_view_;  // lights all around, lights that show as discs, those that the tile may see
  std::vector<Hit> hits_;
  std::vector<SurfacePoint> surfaces_;                   // by path
  std::vector<Direction> to_eye_;                        // by path, in the surface's frame
  std::vector<std::vector<std::uint32_t>> of_material_;  // paths that hit it
  std::vector<std::vector<std::uint32_t>> of_light_;     // of these, those that ask each light
  std::vector<Ray> shadow_rays_;
  std::vector<std::uint32_t> shadow_ray_of_;  // of which arrival each is
  std::vector<Arrival> arrivals_;
  std::vector<Direction> from_light_;
  std::vector<std::uint8_t> blocked_, arrives_not_;  // by shadow ray, by arrival
  DirectionBatch directions_;
  std::vector<double> values_;
  MaterialShader::Scratch scratch_;
  std::vector<double> sums_;               // of one path, by channel
  std::vector<double> weights_, factors_;  // of one vertex, for the observer
  std::span<double> radiance_;
  RenderWork work_;
  double since_ = 0.0;
};

}  // namespace goniofit
