#include "render/tile_renderer.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "render/pixel_samples.h"

namespace goniofit {

namespace {

// Paths traced together: enough for full batches, few enough to stay in the cache.
constexpr std::size_t paths_at_once = 4096;
// From this reflection on paths end by chance, and one of two branches is followed.
constexpr int first_roulette = 2;

// What a pair of random numbers of a path is for.
enum Purpose : std::uint64_t { for_pixel, for_choice, for_lobe, for_direction, for_lights };

std::array<double, 2> random_pair(std::uint64_t key, std::uint64_t purpose, std::uint32_t sample) noexcept {
  return sample_pair(pixel_samples::combined(key, purpose), sample);
}

Direction in_frame(const Frame& frame, const Vec3& v) noexcept {
  return {dot(v, frame.x), dot(v, frame.y), dot(v, frame.z)};
}

void resize(DirectionBatch& batch, std::size_t n) {
  for (std::vector<double>* part : {&batch.l_x, &batch.l_y, &batch.l_z, &batch.v_x, &batch.v_y, &batch.v_z}) {
    part->resize(n);
  }
}

void set(DirectionBatch& batch, std::size_t i, const Direction& l, const Direction& v) {
  batch.l_x[i] = l.x;
  batch.l_y[i] = l.y;
  batch.l_z[i] = l.z;
  batch.v_x[i] = v.x;
  batch.v_y[i] = v.y;
  batch.v_z[i] = v.z;
}

Vec3 off_surface(const SurfacePoint& s) noexcept { return s.position + s.clearance * s.normal; }

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
  const auto now = std::chrono::steady_clock::now();
  work_.*phase += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

void TileRenderer::render(const Tile& tile, std::span<double> radiance) {
  radiance_ = radiance;
  since_ = std::chrono::steady_clock::now();
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

PathVertex TileRenderer::vertex(std::uint32_t path, std::size_t material, const Direction& l) const {
  return {now_.paths[path].observed, material, l, to_eye_[path]};
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
    if (hits_[i].surface >= objects.size()) continue;
    surfaces_[i] = context_.tracer.surface_point(now_.rays[i], hits_[i]);
    to_eye_[i] = in_frame(surfaces_[i].shading, -now_.rays[i].direction);
    const bool seen = to_eye_[i].z > 0.0 && dot(surfaces_[i].normal, now_.rays[i].direction) < 0.0;
    if (seen) of_material_[objects[hits_[i].surface].material].push_back(i);
  }
}

// The camera's hits ask every light, later ones one light each.
void TileRenderer::light_directly(std::size_t material, int bounce) {
  if (!context_.materials[material].has_lobes()) return;
  const std::vector<std::uint32_t>& hits = of_material_[material];
  const std::size_t lights = context_.lights.size();
  if (bounce == 0) {
    for (std::size_t l = 0; l < lights; ++l) draw_light(material, l, 1.0, hits);
    return;
  }
  for (auto& paths : of_light_) paths.clear();
  for (const std::uint32_t i : hits) {
    const Path& path = now_.paths[i];
    const double u = random_pair(path.key, for_choice, path.sample)[0];
    of_light_[static_cast<std::size_t>(u * static_cast<double>(lights))].push_back(i);
  }
  for (std::size_t l = 0; l < lights; ++l) draw_light(material, l, 1.0 / static_cast<double>(lights), of_light_[l]);
}

void TileRenderer::draw_light(std::size_t material, std::size_t light, double chance,
                              const std::vector<std::uint32_t>& hits) {
  const LightSampler& sampler = context_.lights[light];
  if (context_.sampling == LightSampling::model && !sampler.is_delta()) return;
  shadow_rays_.clear();
  arrivals_.clear();
  from_light_.clear();
  lap(&RenderWork::other_s);
  for (const std::uint32_t i : hits) {
    const Path& path = now_.paths[i];
    const SurfacePoint& s = surfaces_[i];
    const auto u = sampler.is_delta() ? std::array{0.0, 0.0} : random_pair(path.key, for_lights + light, path.sample);
    const auto drawn = sampler.sample(s.position, s.shading.z, u);
    if (!drawn) continue;
    const Direction l = in_frame(s.shading, drawn->direction);
    if (!(l.z > 0.0) || !(dot(drawn->direction, s.normal) > 0.0)) continue;
    double weight = drawn->scale * l.z / chance;
    if (drawn->pdf > 0.0 && context_.sampling == LightSampling::both) {
      const double pdf = chance * drawn->pdf;
      weight *= pdf / (pdf + context_.materials[material].pdf(l, to_eye_[i]));
    }
    // It starts as much nearer to the light as it starts off the surface, at most.
    shadow_rays_.push_back({off_surface(s), drawn->direction, drawn->distance - 2.0 * s.clearance});
    arrivals_.push_back({i, weight, drawn->spectrum});
    from_light_.push_back(l);
  }
  lap(&RenderWork::draw_s);
  add_arrivals(material, light, sampler.is_delta());
}

void TileRenderer::add_arrivals(std::size_t material, std::size_t light, bool coherent) {
  if (arrivals_.empty()) return;
  blocked_.resize(shadow_rays_.size());
  context_.tracer.occluded(shadow_rays_, blocked_, coherent);
  work_.shadow_rays += shadow_rays_.size();
  lap(&RenderWork::trace_s);
  resize(directions_, arrivals_.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < arrivals_.size(); ++i) {
    if (blocked_[i] != 0) continue;
    set(directions_, kept, from_light_[i], to_eye_[arrivals_[i].path]);
    arrivals_[kept++] = arrivals_[i];
  }
  if (kept == 0) return;
  resize(directions_, kept);
  lap(&RenderWork::other_s);
  context_.materials[material].values(directions_, scratch_, values_);
  work_.evaluations += kept;
  lap(&RenderWork::evaluate_s);
  for (std::size_t i = 0; i < kept; ++i) {
    Arrival& a = arrivals_[i];
    double* const pixel = &radiance_[now_.paths[a.path].pixel * channels_];
    const double* const throughput = &now_.throughput[a.path * channels_];
    for (std::size_t c = 0; c < channels_; ++c) {
      sums_[c] = throughput[c] * a.weight * a.spectrum[c] * values_[c * kept + i];
    }
    a.weight *= add(now_.paths[a.path], pixel);
  }
  if (context_.observer != nullptr) tell_of_arrivals(material, light, kept);
}

void TileRenderer::tell_of_arrivals(std::size_t material, std::size_t light, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Arrival& a = arrivals_[i];
    weights_.clear();
    factors_.clear();
    for (std::size_t c = 0; c < channels_; ++c) {
      weights_.push_back(now_.throughput[a.path * channels_ + c] * a.weight * a.spectrum[c]);
      factors_.push_back(values_[c * count + i]);
    }
    const Direction l{directions_.l_x[i], directions_.l_y[i], directions_.l_z[i]};
    context_.observer->lit(vertex(a.path, material, l), light, weights_, factors_);
  }
}

void TileRenderer::go_on(std::size_t material, int bounce) {
  const MaterialShader& shader = context_.materials[material];
  // Behind the last reflection nothing is worth a ray but lights that one can run into.
  const bool last = bounce + 1 == context_.scene.image.max_bounces;
  const bool mirrors = shader.has_mirror() && (!last || mirrored_lights_);
  const bool lobes = shader.has_lobes() && (!last || (sized_lights_ && context_.sampling != LightSampling::lights));
  arrivals_.clear();
  from_light_.clear();
  lap(&RenderWork::other_s);
  for (const std::uint32_t i : of_material_[material]) {
    const Path& path = now_.paths[i];
    bool mirror = mirrors, lobe = lobes;
    double chance = 1.0;
    if (mirror && lobe && bounce >= first_roulette) {
      mirror = random_pair(path.key, for_choice, path.sample)[1] < 0.5;
      lobe = !mirror;
      chance = 0.5;
    }
    if (mirror) reflect_in_mirror(material, i, chance);
    if (lobe) reflect_by_model(shader, i, bounce, chance);
  }
  lap(&RenderWork::draw_s);
  add_reflected(material);
}

void TileRenderer::reflect_in_mirror(std::size_t material, std::uint32_t i, double chance) {
  const MaterialShader& shader = context_.materials[material];
  const Direction& v = to_eye_[i];
  const SurfacePoint& s = surfaces_[i];
  const Vec3 direction = s.shading.to_world(-v.x, -v.y, v.z);
  if (!(dot(direction, s.normal) > 0.0)) return;
  const Path& path = now_.paths[i];
  double brightest = 0.0;
  const std::size_t at = next_.throughput.size();
  for (std::size_t c = 0; c < channels_; ++c) {
    const double weight = shader.mirror_weight(v, c);
    brightest = std::max(brightest, weight);
    next_.throughput.push_back(now_.throughput[i * channels_ + c] * weight / chance);
  }
  constexpr double invisible = 1e-12;  // a small lamp may be 1e9 times as bright as what it lights
  if (brightest < invisible) {
    next_.throughput.resize(at);
    return;
  }
  next_.rays.push_back({off_surface(s), direction});
  next_.paths.push_back({.pixel = path.pixel,
                         .key = pixel_samples::combined(path.key, ~std::uint64_t{0}),
                         .sample = path.sample,
                         .normal = s.shading.z,
                         .drawn = path.drawn});
  ++work_.mirror_rays;
  if (context_.observer == nullptr) return;
  factors_.clear();
  for (std::size_t c = 0; c < channels_; ++c) factors_.push_back(shader.mirror_weight(v, c));
  next_.paths.back().observed = context_.observer->goes_on(vertex(i, material, mirrored(v)), true, factors_);
}

// Draws a direction; what it weighs is known when the whole batch is evaluated.
void TileRenderer::reflect_by_model(const MaterialShader& shader, std::uint32_t i, int bounce, double chance) {
  const Path& path = now_.paths[i];
  const auto which = random_pair(path.key, for_lobe, path.sample);
  if (bounce >= first_roulette) {
    if (!(which[1] < shader.survival())) return;
    chance *= shader.survival();
  }
  const auto u = random_pair(path.key, for_direction, path.sample);
  const auto drawn = shader.draw(to_eye_[i], {which[0], u[0], u[1]});
  if (!drawn) return;
  // Each effect may go on with a chance of its own: what is left has the mean of all.
  const bool wide = drawn->chosen != Effect::dd && drawn->chosen != Effect::fs;
  if (bounce == 0 && wide) {
    if (!(which[1] < context_.scene.image.indirect)) return;
    chance *= context_.scene.image.indirect;
  }
  const Direction& l = drawn->direction;
  const Vec3 direction = surfaces_[i].shading.to_world(l.x, l.y, l.z);
  if (!(dot(direction, surfaces_[i].normal) > 0.0)) return;
  from_light_.push_back(l);
  arrivals_.push_back({i, l.z / (drawn->pdf * chance), nullptr});
  const double light_chance = bounce == 0 ? 1.0 : 1.0 / static_cast<double>(context_.lights.size());
  next_.rays.push_back({off_surface(surfaces_[i]), direction});
  next_.paths.push_back({.pixel = path.pixel,
                         .key = pixel_samples::combined(path.key, ~std::uint64_t{1}),
                         .sample = path.sample,
                         .normal = surfaces_[i].shading.z,
                         .pdf = drawn->pdf,
                         .light_chance = light_chance,
                         .drawn = true});
  next_.throughput.insert(next_.throughput.end(), channels_, 0.0);
}

void TileRenderer::add_reflected(std::size_t material) {
  if (arrivals_.empty()) return;
  const MaterialShader& shader = context_.materials[material];
  resize(directions_, arrivals_.size());
  for (std::size_t k = 0; k < arrivals_.size(); ++k) set(directions_, k, from_light_[k], to_eye_[arrivals_[k].path]);
  shader.values(directions_, scratch_, values_);
  const std::size_t n = arrivals_.size();
  work_.evaluations += n;
  work_.path_rays += n;
  lap(&RenderWork::evaluate_s);
  // The drawn paths are those of this material in next_ that no mirror made, in order.
  std::size_t at = next_.size();
  for (std::size_t k = n; k-- > 0;) {
    do --at;
    while (next_.paths[at].pdf == 0.0);
    const Arrival& a = arrivals_[k];
    for (std::size_t c = 0; c < channels_; ++c) {
      next_.throughput[at * channels_ + c] = now_.throughput[a.path * channels_ + c] * a.weight * values_[c * n + k];
    }
    if (context_.observer == nullptr) continue;
    factors_.clear();
    for (std::size_t c = 0; c < channels_; ++c) factors_.push_back(values_[c * n + k]);
    const Direction l{directions_.l_x[k], directions_.l_y[k], directions_.l_z[k]};
    next_.paths[at].observed = context_.observer->goes_on(vertex(a.path, material, l), false, factors_);
  }
}

}  // namespace goniofit
