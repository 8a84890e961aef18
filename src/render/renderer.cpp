#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "render/tile_renderer.h"
#include "support/error.h"
#include "synthetic/parallel.h"

namespace goniofit {

namespace {

constexpr std::size_t tile_size = 32;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Renderers that wait for a tile: each keeps its memory.
class RendererPool {
 public:
  explicit RendererPool(const RenderContext& context) : context_(context) {}
  std::unique_ptr<TileRenderer> take() {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return std::make_unique<TileRenderer>(context_);
    std::unique_ptr<TileRenderer> renderer = std::move(idle_.back());
    idle_.pop_back();
    return renderer;
  }
  void give_back(std::unique_ptr<TileRenderer> renderer) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(renderer));
  }
  [[nodiscard]] RenderWork work() const {
    RenderWork sum;
    for (const auto& renderer : idle_) sum += renderer->work();
    return sum;
  }

 private:
  const RenderContext& context_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TileRenderer>> idle_;
};

std::vector<Tile> tiles_of(const ImageSettings& image) {
  std::vector<Tile> tiles;
  for (std::size_t top = 0; top < image.height; top += tile_size) {
    for (std::size_t left = 0; left < image.width; left += tile_size) {
      tiles.push_back({left, top, std::min(left + tile_size, image.width), std::min(top + tile_size, image.height)});
    }
  }
  return tiles;
}

Frame camera_frame(const Camera& camera) {
  const Vec3 back = normalised(camera.position - camera.look_at);
  const Vec3 right = normalised(cross(camera.up, back));
  return {right, cross(back, right), back};
}

std::vector<std::string> notes_on(const Scene& scene, const std::vector<MaterialShader>& materials) {
  std::vector<std::string> notes;
  std::string mirrors;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].has_mirror()) mirrors += (mirrors.empty() ? "" : ", ") + scene.materials[m].name;
  }
  if (mirrors.empty()) return notes;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    if (mirror_shows(scene.lights[l])) continue;
    notes.push_back("lights/" + std::to_string(l) + " has no size: the mirror component (coh) of " + mirrors +
                    " does not show it");
  }
  return notes;
}

}  // namespace

RenderWork& RenderWork::operator+=(const RenderWork& other) noexcept {
  camera_rays += other.camera_rays;
  path_rays += other.path_rays;
  mirror_rays += other.mirror_rays;
  shadow_rays += other.shadow_rays;
  evaluations += other.evaluations;
  trace_s += other.trace_s;
  evaluate_s += other.evaluate_s;
  draw_s += other.draw_s;
  other_s += other.other_s;
  return *this;
}

Rendering render(const Scene& scene, std::span<const RenderMaterial> materials, const RenderSettings& settings,
                 const RenderProgress& progress) {
  validate(scene, scene.source.string());
  if (materials.size() != scene.materials.size()) {
    throw usage_error(std::to_string(materials.size()) + " materials for a scene of " +
                      std::to_string(scene.materials.size()) + ", expected as many");
  }
  for (const RenderMaterial& m : materials) {
    if (m.material.channels.size() == scene.channels.size()) continue;
    throw usage_error("a material of " + std::to_string(m.material.channels.size()) + " channels in a scene of " +
                      std::to_string(scene.channels.size()) + ", expected as many");
  }
  const Clock::time_point start = Clock::now();
  const Tracer tracer(scene);
  std::vector<LightSampler> lights;
  for (const Light& light : scene.lights) lights.emplace_back(light, scene.channels.size());
  std::vector<MaterialShader> shaders;
  for (std::size_t m = 0; m < materials.size(); ++m) shaders.emplace_back(scene.materials[m].material, materials[m]);

  Rendering result;
  result.picture = {scene.image.width, scene.image.height, scene.channels, {}};
  result.picture.radiance.assign(scene.image.width * scene.image.height * scene.channels.size(), 0.0);
  result.notes = notes_on(scene, shaders);
  result.preparation_s = seconds_since(start);

  const ClearViews clear_views(scene);
  const RenderContext context{
      scene, tracer, lights, clear_views, shaders, settings.sampling, settings.observer, camera_frame(scene.camera)};
  const std::vector<Tile> tiles = tiles_of(scene.image);
  RendererPool pool(context);
  const Clock::time_point first_ray = Clock::now();
  parallel_for(
      tiles.size(),
      [&](std::size_t i) {
        std::unique_ptr<TileRenderer> renderer = pool.take();
        renderer->render(tiles[i], result.picture.radiance);
        pool.give_back(std::move(renderer));
      },
      progress, settings.observer != nullptr ? 1 : settings.threads);
  result.seconds = seconds_since(first_ray);
  result.work = pool.work();
  return result;
}

}  // namespace goniofit
