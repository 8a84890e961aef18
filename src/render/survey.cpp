#include "render/survey.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "geometry/angles.h"
#include "render/path_observer.h"
#include "render/renderer.h"
#include "synthetic/random.h"

namespace goniofit {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

// Writes down every vertex; what a stretch of a path gathered is known, and so what its factor is worth, when all is
// done.
class Recorder final : public PathObserver {
 public:
  struct Vertices {
    std::vector<Direction> l, v;
    std::vector<std::uint32_t> pixel, light;  // light: none where the path goes on
    std::vector<double> weights;              // [vertex * channels + channel]
  };

  Recorder(std::size_t materials, std::size_t channels, std::size_t pixels)
      : channels_(channels),
        lobes_(materials),
        mirrors_(materials),
        sent_(materials, std::vector<double>(pixels * channels)),
        from_surfaces_(sent_) {}

  [[nodiscard]] std::uint32_t begins(std::size_t pixel) override {
    return add({.pixel = static_cast<std::uint32_t>(pixel), .parent = none, .material = 0, .of = nullptr, .vertex = 0});
  }

  [[nodiscard]] std::uint32_t goes_on(const PathVertex& x, bool mirror, std::span<const double> f) override {
    Vertices& of = mirror ? mirrors_[x.material] : lobes_[x.material];
    const auto vertex = static_cast<std::uint32_t>(of.pixel.size());
    write(of, x, none);
    of.weights.insert(of.weights.end(), f.begin(), f.end());  // the factor itself, until finish()
    return add({stretches_[x.path].pixel, x.path, x.material, &of, vertex});
  }

  void lit(const PathVertex& x, std::size_t light, std::span<const double> weight, std::span<const double> f) override {
    Vertices& of = lobes_[x.material];
    write(of, x, static_cast<std::uint32_t>(light));
    of.weights.insert(of.weights.end(), weight.begin(), weight.end());
    const std::uint32_t pixel = stretches_[x.path].pixel;
    for (std::size_t c = 0; c < channels_; ++c) {
      gathered_[x.path * channels_ + c] += weight[c] * f[c];
      sent_[x.material][pixel * channels_ + c] += weight[c] * f[c];
    }
  }

  void met_light(std::uint32_t path, std::span<const double> amount) override {
    for (std::size_t c = 0; c < channels_; ++c) {
      gathered_[path * channels_ + c] += amount[c];
      met_[path * channels_ + c] += amount[c];
    }
  }

  // Stretches come after the ones that they leave: backwards, each is complete when its turn comes.
  void finish() {
    for (std::size_t i = stretches_.size(); i-- > 0;) {
      const Stretch& s = stretches_[i];
      if (s.parent == none) continue;
      for (std::size_t c = 0; c < channels_; ++c) {
        const double amount = gathered_[i * channels_ + c];
        gathered_[s.parent * channels_ + c] += amount;
        sent_[s.material][s.pixel * channels_ + c] += amount;
        from_surfaces_[s.material][s.pixel * channels_ + c] += amount - met_[i * channels_ + c];
        double& factor = s.of->weights[s.vertex * channels_ + c];
        factor = factor > 0.0 ? amount / factor : 0.0;
      }
    }
  }

  [[nodiscard]] const Vertices& lobes(std::size_t material) const { return lobes_[material]; }
  [[nodiscard]] const Vertices& mirrors(std::size_t material) const { return mirrors_[material]; }
  [[nodiscard]] std::vector<double>& sent(std::size_t material) { return sent_[material]; }
  [[nodiscard]] std::vector<double>& from_surfaces(std::size_t material) { return from_surfaces_[material]; }

 private:
  struct Stretch {
    std::uint32_t pixel, parent;
    std::size_t material;  // that it left from
    Vertices* of;          // and there, which vertex
    std::uint32_t vertex;
  };
  std::uint32_t add(const Stretch& s) {
    stretches_.push_back(s);
    gathered_.insert(gathered_.end(), channels_, 0.0);
    met_.insert(met_.end(), channels_, 0.0);
    return static_cast<std::uint32_t>(stretches_.size() - 1);
  }
  void write(Vertices& to, const PathVertex& x, std::uint32_t light) {
    to.l.push_back(x.l);
    to.v.push_back(x.v);
    to.pixel.push_back(stretches_[x.path].pixel);
    to.light.push_back(light);
  }

  std::size_t channels_;
  std::vector<Stretch> stretches_;
  std::vector<double> gathered_, met_;  // [stretch * channels + channel]: all, and what of it lights sent on the way
  std::vector<Vertices> lobes_, mirrors_;
  std::vector<std::vector<double>> sent_, from_surfaces_;
};

// Which pixels are kept of a material: all, or so many at random that their vertices are few enough.
class KeptPixels {
 public:
  KeptPixels(std::size_t vertices, const SurveySettings& settings)
      : part_(static_cast<double>(settings.most_vertices) / static_cast<double>(std::max<std::size_t>(vertices, 1))),
        seed_(subkey(settings.seed, "kept pixels")) {}
  [[nodiscard]] bool has(std::uint32_t pixel) const {
    return part_ >= 1.0 || RandomStream(subkey(seed_, pixel)).uniform() < part_;
  }

 private:
  double part_;
  std::uint64_t seed_;
};

PathFactors kept_of(const Recorder::Vertices& from, const KeptPixels& kept, std::size_t channels) {
  PathFactors to;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < from.pixel.size(); ++i) {
    const double* const w = &from.weights[i * channels];
    const bool matters = std::any_of(w, w + channels, [](double x) { return x > 0.0; });
    if (!matters || !kept.has(from.pixel[i])) continue;
    rows.push_back(i);
    to.directions.push_back(from.l[i], from.v[i]);
    to.pixel.push_back(from.pixel[i]);
  }
  to.weights.reserve(rows.size() * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    for (const std::size_t i : rows) to.weights.push_back(from.weights[i * channels + c]);
  }
  return to;
}

double zenith_deg(double cosine) { return degrees(std::acos(std::clamp(cosine, -1.0, 1.0))); }

Domain domain_of(const PathFactors& lobes, const PathFactors& mirrors) {
  Domain d{.theta_i_min_deg = 90.0, .theta_i_max_deg = 0.0, .theta_r_max_deg = 0.0};
  for (const PathFactors* f : {&lobes, &mirrors}) {
    for (std::size_t i = 0; i < f->size(); ++i) {
      const double theta_i = zenith_deg(f->directions.l_z[i]);
      d.theta_i_min_deg = std::min(d.theta_i_min_deg, theta_i);
      d.theta_i_max_deg = std::max(d.theta_i_max_deg, theta_i);
      d.theta_r_max_deg = std::max(d.theta_r_max_deg, zenith_deg(f->directions.v_z[i]));
    }
  }
  return d;
}

// How far v is from the mirror direction of l, as a length between unit vectors.
double mirror_distance(const Direction& l, const Direction& v) {
  return std::sqrt((l.x + v.x) * (l.x + v.x) + (l.y + v.y) * (l.y + v.y) + (l.z - v.z) * (l.z - v.z));
}

// Of one light: the pixel nearest to its mirror image, and whether the image may be seen. Distances change from pixel
// to pixel; where the least of them is smaller than its change to some neighbour, the image lies at that pixel or
// between it and the next.
struct Nearest {
  double distance;
  Direction v;
};
using NearestOf = std::map<std::uint32_t, Nearest>;  // by pixel

std::optional<MirrorImage> image_in_view(std::size_t light, const NearestOf& nearest, std::size_t width) {
  const auto least = std::min_element(nearest.begin(), nearest.end(), [](const auto& a, const auto& b) {
    return a.second.distance < b.second.distance;
  });
  double change = 0.0;
  const auto column = static_cast<long>(least->first % width);
  const auto row = static_cast<long>(least->first / width);
  for (long r = std::max(0L, row - 1); r <= row + 1; ++r) {
    for (long c = std::max(0L, column - 1); c <= std::min(static_cast<long>(width) - 1, column + 1); ++c) {
      const auto neighbour = nearest.find(static_cast<std::uint32_t>(r * static_cast<long>(width) + c));
      if (neighbour == nearest.end()) continue;
      change = std::max(change, neighbour->second.distance - least->second.distance);
    }
  }
  if (least->second.distance > change) return std::nullopt;
  return MirrorImage{light, least->first, least->second.v};
}

std::vector<MirrorImage> images_of(const Scene& scene, const Recorder::Vertices& vertices, std::size_t width) {
  std::map<std::uint32_t, NearestOf> of_light;
  for (std::size_t i = 0; i < vertices.pixel.size(); ++i) {
    const std::uint32_t light = vertices.light[i];
    if (light == none || !mirror_shows(scene.lights[light])) continue;
    if (std::holds_alternative<EnvironmentLight>(scene.lights[light])) continue;
    const Nearest here{mirror_distance(vertices.l[i], vertices.v[i]), vertices.v[i]};
    const auto [at, is_new] = of_light[light].try_emplace(vertices.pixel[i], here);
    if (!is_new && here.distance < at->second.distance) at->second = here;
  }
  std::vector<MirrorImage> images;
  for (const auto& [light, nearest] : of_light) {
    if (const auto image = image_in_view(light, nearest, width)) images.push_back(*image);
  }
  return images;
}

}  // namespace

Scene in_small(const Scene& scene, std::size_t pixels, std::size_t samples, std::uint64_t seed) {
  Scene small = scene;
  const auto width = static_cast<double>(scene.image.width);
  const auto height = static_cast<double>(scene.image.height);
  const double scale = std::min(1.0, std::sqrt(static_cast<double>(pixels) / (width * height)));
  small.image.width = static_cast<std::size_t>(std::max(1.0, std::round(scale * width)));
  small.image.height = static_cast<std::size_t>(std::max(1.0, std::round(scale * height)));
  small.image.samples = samples;
  small.image.seed = seed;
  return small;
}

SceneSurvey survey(const Scene& scene, std::span<const RenderMaterial> materials, const SurveySettings& settings) {
  const std::size_t channels = scene.channels.size();
  const Scene small = in_small(scene, settings.pixels, settings.samples, subkey(settings.seed, "survey"));
  Recorder recorder(scene.materials.size(), channels, small.image.width * small.image.height);
  const Rendering rendering = render(small, materials, {.threads = 1, .observer = &recorder});
  recorder.finish();
  SceneSurvey result{small.image.width, small.image.height, small.image.seed, rendering.picture.radiance, {}};
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Recorder::Vertices& lobes = recorder.lobes(m);
    const Recorder::Vertices& mirrors = recorder.mirrors(m);
    const KeptPixels kept(lobes.pixel.size() + mirrors.pixel.size(), settings);
    MaterialSurvey s;
    s.lobes = kept_of(lobes, kept, channels);
    s.mirrors = kept_of(mirrors, kept, channels);
    s.sent = std::move(recorder.sent(m));
    s.from_surfaces = std::move(recorder.from_surfaces(m));
    s.seen = s.lobes.size() + s.mirrors.size() > 0;
    if (s.seen) s.domain = domain_of(s.lobes, s.mirrors);
    if (materials[m].material.components.has(Effect::coh)) s.images = images_of(scene, lobes, small.image.width);
    result.materials.push_back(std::move(s));
  }
  return result;
}

}  // namespace goniofit
