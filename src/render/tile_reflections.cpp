// What happens where paths meet surfaces: light from lights, and where the paths go on.

#include <algorithm>
#include <cmath>

#include "render/tile_parts.h"
#include "render/tile_renderer.h"

namespace goniofit {

namespace {

// From this reflection on paths end by chance, and one of two branches is followed.
constexpr int first_roulette = 2;

}  // namespace

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
  const bool delta = sampler.is_delta();
  const PointLight* const point = sampler.point();
  shadow_rays_.clear();
  shadow_ray_of_.clear();
  arrivals_.clear();
  from_light_.clear();
  lap(&RenderWork::other_s);
  for (const std::uint32_t i : hits) {
    const Path& path = now_.paths[i];
    const SurfacePoint& s = surfaces_[i];
    const auto draw = [&] {
      if (point != nullptr) return LightSampler::sample_of(*point, s.position);
      const auto u = delta ? std::array{0.0, 0.0} : random_pair(path.key, for_lights + light, path.sample);
      return sampler.sample(s.position, s.shading.z, u);
    };
    const auto drawn = draw();
    if (!drawn) continue;
    const Direction l = in_frame(s.shading, drawn->direction);
    if (!(l.z > 0.0) || !(dot(drawn->direction, s.normal) > 0.0)) continue;
    double weight = drawn->scale * l.z / chance;
    if (drawn->pdf > 0.0 && context_.sampling == LightSampling::both) {
      const double pdf = chance * drawn->pdf;
      weight *= pdf / (pdf + context_.materials[material].pdf(l, to_eye_[i]));
    }
    if (!context_.clear_views.has(hits_[i].surface, light)) {
      // It starts as much nearer to the light as it starts off the surface, at most.
      shadow_rays_.push_back({off_surface(s), drawn->direction, drawn->distance - 2.0 * s.clearance});
      shadow_ray_of_.push_back(static_cast<std::uint32_t>(arrivals_.size()));
    }
    arrivals_.push_back({i, weight, drawn->spectrum});
    from_light_.push_back(l);
  }
  lap(&RenderWork::draw_s);
  add_arrivals(material, light, delta);
}

void TileRenderer::add_arrivals(std::size_t material, std::size_t light, bool coherent) {
  if (arrivals_.empty()) return;
  arrives_not_.assign(arrivals_.size(), 0);
  if (!shadow_rays_.empty()) {
    blocked_.resize(shadow_rays_.size());
    context_.tracer.occluded(shadow_rays_, blocked_, coherent);
    for (std::size_t k = 0; k < blocked_.size(); ++k) arrives_not_[shadow_ray_of_[k]] = blocked_[k];
    work_.shadow_rays += shadow_rays_.size();
  }
  lap(&RenderWork::trace_s);
  resize(directions_, arrivals_.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < arrivals_.size(); ++i) {
    if (arrives_not_[i] != 0) continue;
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

PathVertex TileRenderer::vertex(std::uint32_t path, std::size_t material, const Direction& l) const {
  return {now_.paths[path].observed, material, l, to_eye_[path]};
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
  const bool last = bounce + 1 == context_.scene.image.max_bounces || !shader.follows();
  const bool mirrors = shader.has_mirror() && (!last || mirrored_lights_);
  const bool lobes = shader.has_lobes() && (!last || (sized_lights_ && context_.sampling != LightSampling::lights));
  arrivals_.clear();
  from_light_.clear();
  lap(&RenderWork::other_s);
  for (const std::uint32_t i : of_material_[material]) {
    const Path& path = now_.paths[i];
    bool mirror = mirrors, lobe = lobes;
    double chance = 1.0;
    if (shader.branches() && bounce >= first_roulette) {
      const bool first = random_pair(path.key, for_choice, path.sample)[1] < 0.5;
      mirror = mirror && first;
      lobe = lobe && !first;
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
                         .drawn = path.drawn,
                         .lights_only = !shader.follows()});
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
  // Each effect may go on with a chance of its own: what is left has the mean of all.
  const double indirect = context_.scene.image.indirect;
  if (bounce == 0 && indirect < 1.0 && shader.draws_wide(to_eye_[i], which[0])) {
    if (!(which[1] < indirect)) return;
    chance *= indirect;
  }
  const auto u = random_pair(path.key, for_direction, path.sample);
  const auto drawn = shader.draw(to_eye_[i], {which[0], u[0], u[1]});
  if (!drawn) return;
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
                         .drawn = true,
                         .lights_only = !shader.follows()});
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
