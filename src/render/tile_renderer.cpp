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
      of_material_(context.materials.size()),
      of_light_(context.lights.size()),
      sums_(channels_) {
  for (const LightSampler& light : context_.lights) sized_lights_ = sized_lights_ || !light.is_delta();
  for (const Light& light : context_.scene.lights) mirrored_lights_ = mirrored_lights_ || mirror_shows(light);
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
  const std::size_t at_once = std::max<std::size_t>(1, paths_at_once / pixels);
  for (std::size_t first = 0; first < image.samples; first += at_once) {
    start_paths(tile, first, std::min(at_once, image.samples - first));
    for (int bounce = 0; now_.size() > 0; ++bounce) {
      trace();
      collect_emission();
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

void TileRenderer::start_paths(const Tile& tile, std::size_t first_sample, std::size_t samples) {
  const ImageSettings& image = context_.scene.image;
  const Camera& camera = context_.scene.camera;
  const double half_height = std::tan(0.5 * radians(camera.fov_deg));
  const double pixel_size = 2.0 * half_height / static_cast<double>(image.height);
  now_.clear();
  for (std::size_t row = tile.top; row < tile.bottom; ++row) {
    for (std::size_t column = tile.left; column < tile.right; ++column) {
      const std::size_t pixel = row * image.width + column;
      const std::uint64_t key = pixel_samples::combined(image.seed, pixel);
      for (std::size_t s = 0; s < samples; ++s) {
        const auto sample = static_cast<std::uint32_t>(first_sample + s);
        const auto within = image.samples == 1 ? std::array{0.5, 0.5} : random_pair(key, for_pixel, sample);
        const double x =
            (static_cast<double>(column) + within[0] - 0.5 * static_cast<double>(image.width)) * pixel_size;
        const double y = (0.5 * static_cast<double>(image.height) - static_cast<double>(row) - within[1]) * pixel_size;
        now_.rays.push_back({camera.position, normalised(context_.camera.to_world(x, y, -1.0))});
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
  add(now_.paths[path], pixel);
  if (context_.observer != nullptr) context_.observer->met_light(now_.paths[path].observed, sums_);
}

double TileRenderer::add(const Path& path, double* pixel) {
  double scale = 1.0;
  if (path.drawn && context_.scene.image.path_limit) {
    const double brightest = *std::max_element(sums_.begin(), sums_.end());
    const double most = *context_.scene.image.path_limit / static_cast<double>(context_.scene.image.samples);
    if (brightest > most) scale = most / brightest;
  }
  for (double& sum : sums_) sum *= scale;
  for (std::size_t c = 0; c < channels_; ++c) pixel[c] += sums_[c];
  return scale;
}

// What the rays themselves run into. A ray that the model drew shares a light that has a size with the drawing of
// lights.
void TileRenderer::collect_emission() {
  const std::size_t objects = context_.scene.objects.size();
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
    for (std::size_t l = 0; l < context_.lights.size(); ++l) {
      const LightSampler& light = context_.lights[l];
      const bool met = light.surrounds() ? hit.surface == nothing : hit.surface == objects + l;
      if (light.is_delta()) {
        if (!specular) continue;
        if (const auto disc = light.disc(now_.rays[i], hit.distance)) add_emission(i, *disc, 1.0);
      } else if (met) {
        const auto emission = light.emission(now_.rays[i], hit.distance, path.normal);
        add_emission(i, emission, share(emission.pdf));
      }
    }
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
