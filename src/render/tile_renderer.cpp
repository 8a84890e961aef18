#include "render/tile_renderer.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "render/tile_parts.h"

namespace goniofit {

namespace {

// Paths traced together: enough for full batches, few enough to stay in the cache.
constexpr std::size_t paths_at_once = 4096;

// Of the processor, for this thread: what others run meanwhile does not count.
double thread_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

TileRenderer::TileRenderer(const RenderContext& context)
    : context_(context),
      channels_(context.channels()),
      pixel_size_(2.0 * std::tan(0.5 * radians(context.scene.camera.fov_deg)) /
                  static_cast<double>(context.scene.image.height)),
      of_material_(context.materials.size()),
      of_light_(context.lights.size()),
      sums_(channels_) {
  for (const LightSampler& light : context_.lights) sized_lights_ = sized_lights_ || !light.is_delta();
  for (std::size_t l = 0; l < context_.lights.size(); ++l) {
    const bool shows = mirror_shows(context_.scene.lights[l]);
    mirrored_lights_ = mirrored_lights_ || shows;
    if (context_.lights[l].surrounds()) skies_.push_back(l);
    if (shows && context_.lights[l].is_delta()) discs_.push_back(l);
  }
}

void TileRenderer::lap(double RenderWork::*phase) {
  const double now = thread_seconds();
  work_.*phase += now - since_;
  since_ = now;
}

void TileRenderer::render(const Tile& tile, std::span<double> radiance) {
  radiance_ = radiance;
  since_ = thread_seconds();
  const ImageSettings& image = context_.scene.image;
  const std::size_t pixels = (tile.right - tile.left) * (tile.bottom - tile.top);
  find_discs(tile);
  const std::size_t at_once = std::max<std::size_t>(1, paths_at_once / pixels);
  for (std::size_t first = 0; first < image.samples; first += at_once) {
    start_paths(tile, first, std::min(at_once, image.samples - first));
    for (int bounce = 0; now_.size() > 0; ++bounce) {
      trace();
      collect_emission(bounce);
      next_.clear();
      if (bounce < image.max_bounces) {
        find_surfaces();
        for (std::size_t m = 0; m < of_material_.size(); ++m) {
          if (of_material_[m].empty()) continue;
          light_directly(m, bounce);
          go_on(m, bounce);
        }
      }
      std::swap(now_, next_);
    }
  }
  lap(&RenderWork::other_s);
}

// Through a place of the image, in pixels from its upper left corner.
Vec3 TileRenderer::camera_direction(double column, double row) const {
  const ImageSettings& image = context_.scene.image;
  const double x = (column - 0.5 * static_cast<double>(image.width)) * pixel_size_;
  const double y = (0.5 * static_cast<double>(image.height) - row) * pixel_size_;
  return normalised(context_.camera.to_world(x, y, -1.0));
}

void TileRenderer::start_paths(const Tile& tile, std::size_t first_sample, std::size_t samples) {
  const ImageSettings& image = context_.scene.image;
  now_.clear();
  for (std::size_t row = tile.top; row < tile.bottom; ++row) {
    for (std::size_t column = tile.left; column < tile.right; ++column) {
      const std::size_t pixel = row * image.width + column;
      const std::uint64_t key = pixel_samples::combined(image.seed, pixel);
      for (std::size_t s = 0; s < samples; ++s) {
        const auto sample = static_cast<std::uint32_t>(first_sample + s);
        const auto within = image.samples == 1 ? std::array{0.5, 0.5} : random_pair(key, for_pixel, sample);
        now_.rays.push_back({context_.scene.camera.position, camera_direction(static_cast<double>(column) + within[0],
                                                                              static_cast<double>(row) + within[1])});
        now_.paths.push_back({.pixel = pixel, .key = key, .sample = sample, .normal = {}});
        if (context_.observer != nullptr) now_.paths.back().observed = context_.observer->begins(pixel);
        now_.throughput.insert(now_.throughput.end(), channels_, 1.0 / static_cast<double>(image.samples));
      }
    }
  }
  work_.camera_rays += now_.size();
}

void TileRenderer::trace() {
  hits_.resize(now_.size());
  lap(&RenderWork::other_s);
  context_.tracer.intersect(now_.rays, hits_, now_.paths.front().pdf == 0.0);
  lap(&RenderWork::trace_s);
}

void TileRenderer::add_emission(std::size_t path, const LightSampler::Emission& emission, double weight) {
  double* const pixel = &radiance_[now_.paths[path].pixel * channels_];
  const double* const throughput = &now_.throughput[path * channels_];
  const double scale = emission.scale * weight;
  if (scale == 0.0) return;
  for (std::size_t c = 0; c < channels_; ++c) sums_[c] = throughput[c] * scale * emission.spectrum[c];
  const double scale_left = add(now_.paths[path], pixel);
  if (context_.observer == nullptr) return;
  for (double& sum : sums_) sum *= scale_left;
  context_.observer->met_light(now_.paths[path].observed, sums_);
}

double TileRenderer::part_within_limit() const {
  const double brightest = *std::max_element(sums_.begin(), sums_.end());
  const double most = *context_.scene.image.path_limit / static_cast<double>(context_.scene.image.samples);
  return brightest > most ? most / brightest : 1.0;
}

// What the rays themselves run into. A ray that the model drew shares a light that has a size with the drawing of
// lights.
void TileRenderer::collect_emission(int bounce) {
  const std::size_t objects = context_.scene.objects.size();
  const std::vector<std::size_t>& discs = bounce == 0 ? discs_in_view_ : discs_;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Hit& hit = hits_[i];
    const Path& path = now_.paths[i];
    const bool specular = path.pdf == 0.0;
    const auto share = [&](double light_pdf) {
      if (specular) return 1.0;
      if (context_.sampling == LightSampling::lights) return 0.0;
      if (context_.sampling == LightSampling::model) return 1.0;
      return path.pdf / (path.pdf + path.light_chance * light_pdf);
    };
    const auto add_met = [&](std::size_t l) {
      const auto emission = context_.lights[l].emission(now_.rays[i], hit.distance, path.normal);
      add_emission(i, emission, share(emission.pdf));
    };
    if (hit.surface == nothing) {
      for (const std::size_t l : skies_) add_met(l);
    } else if (hit.surface >= objects) {
      add_met(hit.surface - objects);
    }
    if (!specular) continue;
    for (const std::size_t l : discs) {
      if (const auto disc = context_.lights[l].disc(now_.rays[i], hit.distance)) add_emission(i, *disc, 1.0);
    }
  }
}

// Of the discs those that the tile's cone of directions touches.
void TileRenderer::find_discs(const Tile& tile) {
  const Vec3& eye = context_.scene.camera.position;
  const auto corner = [&](std::size_t column, std::size_t row) {
    return camera_direction(static_cast<double>(column), static_cast<double>(row));
  };
  const Vec3 axis = camera_direction(0.5 * static_cast<double>(tile.left + tile.right),
                                     0.5 * static_cast<double>(tile.top + tile.bottom));
  double least = 1.0;
  for (const Vec3& c : {corner(tile.left, tile.top), corner(tile.right, tile.top), corner(tile.left, tile.bottom),
                        corner(tile.right, tile.bottom)}) {
    least = std::min(least, dot(axis, c));
  }
  constexpr double slack = 1e-6;
  const double half_angle = std::acos(std::clamp(least, -1.0, 1.0)) + slack;
  discs_in_view_.clear();
  for (const std::size_t l : discs_) {
    const auto [direction, radius] = context_.lights[l].disc_from(eye);
    if (std::acos(std::clamp(dot(axis, direction), -1.0, 1.0)) <= half_angle + radius) discs_in_view_.push_back(l);
  }
}

void TileRenderer::find_surfaces() {
  surfaces_.resize(now_.size());
  to_eye_.resize(now_.size());
  for (auto& paths : of_material_) paths.clear();
  const std::vector<Object>& objects = context_.scene.objects;
  for (std::uint32_t i = 0; i < now_.size(); ++i) {
    if (hits_[i].surface >= objects.size() || now_.paths[i].lights_only) continue;
    surfaces_[i] = context_.tracer.surface_point(now_.rays[i], hits_[i]);
    to_eye_[i] = in_frame(surfaces_[i].shading, -now_.rays[i].direction);
    const bool seen = to_eye_[i].z > 0.0 && dot(surfaces_[i].normal, now_.rays[i].direction) < 0.0;
    if (seen) of_material_[objects[hits_[i].surface].material].push_back(i);
  }
}

}  // namespace goniofit
