#pragma once
// Lights as a path meets them: drawn from a point, run into by a ray, or seen in a mirror.

#include <array>
#include <optional>
#include <vector>

#include "scene.h"
#include "tracer.h"

namespace goniofit {

/// A direction to a light from a point.
struct LightSample {
  Vec3 direction;          ///< a unit vector
  double distance;         ///< free of anything but the light itself
  double scale;            ///< radiance over pdf, or irradiance facing the light, is scale times `spectrum`
  double pdf;              ///< per steradian; 0 for a light without size, which no other way finds
  const double* spectrum;  ///< of all channels
};

class LightSampler {
 public:
  /// Refers to the light, which must outlive it.
  LightSampler(const Light& light, std::size_t channels);

  /// Without size: found by drawing alone.
  [[nodiscard]] bool is_delta() const noexcept;
  /// A light of the same strength and place for every point: its shadow rays go alike.
  [[nodiscard]] bool surrounds() const noexcept { return sky_ != nullptr; }

  /// From a point whose normal is `normal` (the sky above it alone is drawn), by two numbers in [0, 1). Null where none
  /// of it shines there.
  [[nodiscard]] std::optional<LightSample> sample(const Vec3& point, const Vec3& normal,
                                                  const std::array<double, 2>& u) const noexcept;

  /// Null for other lights.
  [[nodiscard]] const PointLight* point() const noexcept { return point_; }
  /// sample() of a point light; here, so that the loop over many points has it within.
  [[nodiscard]] static std::optional<LightSample> sample_of(const PointLight& light, const Vec3& point) noexcept {
    const Vec3 to = light.position - point;
    const double square = dot(to, to);
    if (!(square > 0.0)) return std::nullopt;
    const double distance = std::sqrt(square);
    return LightSample{(1.0 / distance) * to, distance, 1.0 / square, 0.0, light.intensity.data()};
  }

  /// What a ray brings from it: the density with which sample() draws its direction, and radiance = scale * spectrum.
  struct Emission {
    double scale, pdf;
    const double* spectrum;
  };
  /// An area light that the ray meets at this distance, the sky where it meets nothing.
  [[nodiscard]] Emission emission(const Ray& ray, double distance, const Vec3& normal) const noexcept;
  /// The disc of a point or directional light, for rays of the camera and of mirrors; null where the ray passes it by
  /// or meets something before, at `distance`.
  [[nodiscard]] std::optional<Emission> disc(const Ray& ray, double distance) const noexcept;
  /// Where a point sees that disc: about this direction, within this angle in radians.
  struct DiscView {
    Vec3 direction;
    double radius;
  };
  [[nodiscard]] DiscView disc_from(const Vec3& point) const noexcept;

 private:
  [[nodiscard]] std::optional<LightSample> sample_area(const Vec3& point,
                                                       const std::array<double, 2>& u) const noexcept;
  [[nodiscard]] std::optional<LightSample> sample_sky(const Vec3& normal,
                                                      const std::array<double, 2>& u) const noexcept;
  void tabulate(const EnvironmentMap& map);
  [[nodiscard]] std::size_t cell_of(const Vec3& direction) const noexcept;
  [[nodiscard]] double cell_pdf(std::size_t cell) const noexcept;

  const PointLight* point_ = nullptr;
  const DirectionalLight* sun_ = nullptr;
  const AreaLight* area_ = nullptr;
  const EnvironmentLight* sky_ = nullptr;
  // Of a map: cumulative sums of the cells' weights by row, and of the rows; cells are small patches of equal width in
  // both angles.
  std::vector<double> rows_, cells_;
  std::vector<double> scaled_;  // the map's values times the light's
  std::size_t channels_;
};

}  // namespace goniofit
