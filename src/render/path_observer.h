#pragma once
// What a render may be asked to tell of its light paths: how much each value of a material is worth to the image.

#include <cstddef>
#include <cstdint>
#include <span>

#include "../geometry/direction.h"

namespace goniofit {

/// Where light from l leaves for v, at one surface of a path. Directions in the material's frame.
struct PathVertex {
  std::uint32_t path;
  std::size_t material;
  Direction l, v;
};

/// Paths are stretches between surfaces, named by what `begins` and `goes_on` return. Spectra have one number a channel
/// and live for the call only; amounts are of the pixel's radiance.
class PathObserver {
 public:
  virtual ~PathObserver() = default;
  /// The camera's ray through a pixel.
  [[nodiscard]] virtual std::uint32_t begins(std::size_t pixel) = 0;
  /// Another stretch leaves `vertex.path` along l: all that it gathers has f as a factor, or, of a mirror's, the part
  /// k_dd F S exp(-g) that coh reflects.
  [[nodiscard]] virtual std::uint32_t goes_on(const PathVertex& vertex, bool mirror, std::span<const double> f) = 0;
  /// A light adds weight * f.
  virtual void lit(const PathVertex& vertex, std::size_t light, std::span<const double> weight,
                   std::span<const double> f) = 0;
  /// The path itself ran into a light, which adds this.
  virtual void met_light(std::uint32_t path, std::span<const double> amount) = 0;
};

}  // namespace goniofit
