#pragma once
// What an error of a material does to the image of a scene, to first order. Private to the scene planner.

#include <span>
#include <vector>

#include "../cost/model_error.h"
#include "survey.h"

namespace goniofit {

/// An image of a light in a mirror that stands out of what is around it: a few pixels, which no mean over pixels
/// notices.
struct StandingImage {
  std::size_t light;
  Direction v;
  double contrast;  ///< its radiance over that of the survey's pixel there
};

/// Of the survey's images of one material those that are brighter than `least` times their surroundings.
[[nodiscard]] std::vector<StandingImage> standing_images(const Scene& scene, const SceneSurvey& survey,
                                                         const MaterialSurvey& of_material, const Material& material,
                                                         double least);

/// The relative RMS change of the image, likewise over the pixels that the material sends light to, where it no longer
/// sends on what other surfaces sent to it.
[[nodiscard]] double indirect_part(const SceneSurvey& survey, const MaterialSurvey& of_material, std::size_t channels);

/// Where ImageError reads a material's values: the survey's directions, mirror directions those of its mirrors, then of
/// the images.
[[nodiscard]] ErrorSamples image_error_samples(const MaterialSurvey& of_material, std::span<const StandingImage> images,
                                               double solid_angle_sr);

/// worst_l1 is the relative RMS change of radiance over pixels and channels, each by the part of its light that the
/// material sends, so that a pixel which the material hardly touches does not thin out one that shows it; or the
/// relative change of a standing image where that is more. worst_l1_bound has three standard errors of the former in
/// it.
class ImageError {
 public:
  /// Keeps references to the surveys.
  ImageError(const SceneSurvey& survey, const MaterialSurvey& of_material, std::size_t channels);
  [[nodiscard]] ModelError operator()(const ModelValues& reference, const ModelValues& other) const;

 private:
  struct Rows {
    const PathFactors* factors;
    std::vector<std::size_t> of_factor;  // among pixels_
  };
  void add(const Rows& rows, std::span<const double> values, std::vector<double>& sums) const;
  [[nodiscard]] std::vector<double> sent(const ModelValues& values) const;
  [[nodiscard]] double image_change(const ModelValues& reference, const ModelValues& other) const;

  const SceneSurvey& survey_;
  std::size_t channels_;
  std::vector<double> lit_from_;
  std::vector<std::uint32_t> pixels_;
  Rows lobes_, mirrors_;
};

}  // namespace goniofit
