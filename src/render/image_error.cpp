#include "render/image_error.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "render/picture_difference.h"

namespace goniofit {

namespace {

// A weighted mean and its standard error.
class Moments {
 public:
  void add(double weight, double x) noexcept {
    w_ += weight;
    wx_ += weight * x;
    ww_ += weight * weight;
    wwx_ += weight * weight * x;
    wwxx_ += weight * weight * x * x;
  }
  [[nodiscard]] double mean() const noexcept { return w_ > 0.0 ? wx_ / w_ : 0.0; }
  [[nodiscard]] double standard_error() const noexcept {
    if (!(w_ > 0.0)) return 0.0;
    return std::sqrt(std::max(0.0, wwxx_ - 2.0 * mean() * wwx_ + mean() * mean() * ww_)) / w_;
  }

 private:
  double w_ = 0.0, wx_ = 0.0, ww_ = 0.0, wwx_ = 0.0, wwxx_ = 0.0;
};

double disc_solid_angle(double diameter_deg) { return 2.0 * pi * (1.0 - cos_deg(0.5 * diameter_deg)); }

// Radiance of what a mirror shows of a light.
double image_radiance(const Light& light, std::size_t channel) {
  struct Radiance {
    std::size_t c;
    double operator()(const PointLight& l) const { return l.intensity[c] / (pi * l.radius * l.radius); }
    double operator()(const DirectionalLight& l) const { return l.irradiance[c] / disc_solid_angle(l.diameter_deg); }
    double operator()(const AreaLight& l) const { return l.radiance[c]; }
    double operator()(const EnvironmentLight& l) const { return l.radiance[c]; }
  };
  return std::visit(Radiance{channel}, light);
}

double part_of_coh(const Evaluator& evaluator, const Direction& v, std::size_t channel) {
  const Pair pair = make_pair(mirrored(v), v);
  return evaluator.value(pair, channel, Effect::coh) * pair.cos_i * evaluator.material().solid_angle_sr;
}

}  // namespace

std::vector<StandingImage> standing_images(const Scene& scene, const SceneSurvey& survey,
                                           const MaterialSurvey& of_material, const Material& material, double least) {
  std::vector<StandingImage> standing;
  if (of_material.images.empty()) return standing;
  const Evaluator evaluator(material);
  const std::size_t channels = scene.channels.size();
  for (const MirrorImage& image : of_material.images) {
    double contrast = 0.0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double around = survey.radiance[image.pixel * channels + c];
      const double radiance = part_of_coh(evaluator, image.v, c) * image_radiance(scene.lights[image.light], c);
      if (around > 0.0) contrast = std::max(contrast, radiance / around);
    }
    if (contrast > least) standing.push_back({image.light, image.v, contrast});
  }
  return standing;
}

double indirect_part(const SceneSurvey& survey, const MaterialSurvey& s, std::size_t channels) {
  const std::vector<double> from = lit_from(survey.radiance, channels);
  Moments squares;
  for (std::size_t k = 0; k < survey.radiance.size(); ++k) {
    const double radiance = survey.radiance[k];
    if (!(radiance > from[k % channels])) continue;
    const double part = s.from_surfaces[k] / radiance;
    squares.add(std::min(1.0, s.sent[k] / radiance), part * part);
  }
  return std::sqrt(squares.mean() + 3.0 * squares.standard_error());
}

ErrorSamples image_error_samples(const MaterialSurvey& s, std::span<const StandingImage> images,
                                 double solid_angle_sr) {
  ErrorSamples samples{.theta_i_deg = {},
                       .first = {0, s.lobes.size()},
                       .directions = s.lobes.directions,
                       .weights = {},
                       .drawn = 1.0,
                       .mirrors = s.mirrors.directions,
                       .theta_r_max_deg = 90.0,
                       .solid_angle_sr = solid_angle_sr};
  for (const StandingImage& image : images) samples.mirrors.push_back(mirrored(image.v), image.v);
  return samples;
}

ImageError::ImageError(const SceneSurvey& survey, const MaterialSurvey& s, std::size_t channels)
    : survey_(survey),
      channels_(channels),
      lit_from_(lit_from(survey.radiance, channels)),
      lobes_{&s.lobes, {}},
      mirrors_{&s.mirrors, {}} {
  std::map<std::uint32_t, std::size_t> rows;
  for (Rows* r : {&lobes_, &mirrors_}) {
    for (const std::uint32_t pixel : r->factors->pixel) {
      const auto [at, is_new] = rows.try_emplace(pixel, pixels_.size());
      if (is_new) pixels_.push_back(pixel);
      r->of_factor.push_back(at->second);
    }
  }
}

// `values` may go on behind those of the factors in each channel.
void ImageError::add(const Rows& rows, std::span<const double> values, std::vector<double>& sums) const {
  const std::size_t n = rows.factors->size();
  const std::size_t stride = values.size() / channels_;
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      sums[rows.of_factor[i] * channels_ + c] += rows.factors->weights[c * n + i] * values[c * stride + i];
    }
  }
}

// What of each pixel's radiance has the material's values as a factor.
std::vector<double> ImageError::sent(const ModelValues& values) const {
  std::vector<double> sums(pixels_.size() * channels_, 0.0);
  add(lobes_, values.f, sums);
  add(mirrors_, values.mirror_energy, sums);
  return sums;
}

double ImageError::image_change(const ModelValues& reference, const ModelValues& other) const {
  const std::size_t stride = reference.mirror_energy.size() / channels_;
  double most = 0.0;
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t i = mirrors_.factors->size(); i < stride; ++i) {
      const double energy = reference.mirror_energy[c * stride + i];
      if (energy > 0.0) most = std::max(most, std::fabs(other.mirror_energy[c * stride + i] / energy - 1.0));
    }
  }
  return most;
}

ModelError ImageError::operator()(const ModelValues& reference, const ModelValues& other) const {
  const std::vector<double> before = sent(reference);
  const std::vector<double> after = sent(other);
  ModelError e;
  Moments squares;
  double changes = 0.0;
  double light = 0.0;
  for (std::size_t row = 0; row < pixels_.size(); ++row) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::size_t k = row * channels_ + c;
      const double radiance = survey_.radiance[pixels_[row] * channels_ + c];
      if (!(radiance > lit_from_[c])) continue;
      const double change = std::fabs(after[k] - before[k]);
      const double relative = change / radiance;
      squares.add(std::min(1.0, before[k] / radiance), relative * relative);
      changes += change;
      light += radiance;
      e.max_relative = std::max(e.max_relative, relative);
    }
  }
  if (!(light > 0.0)) return e;
  const double of_image = image_change(reference, other);
  e.l1 = changes / light;
  e.rms_relative = std::sqrt(squares.mean());
  e.worst_l1 = std::max(e.rms_relative, of_image);
  e.worst_l1_bound = std::max(std::sqrt(squares.mean() + 3.0 * squares.standard_error()), of_image);
  return e;
}

}  // namespace goniofit
