#include "render/picture_difference.h"

#include <algorithm>
#include <cmath>

#include "support/error.h"

namespace goniofit {

std::vector<double> lit_from(std::span<const double> radiance, std::size_t channels) {
  constexpr double part_of_mean = 1e-2;  // below, a screen shows black
  std::vector<double> from(channels, 0.0);
  for (std::size_t i = 0; i < radiance.size(); ++i) from[i % channels] += radiance[i];
  for (double& f : from) f *= part_of_mean * static_cast<double>(channels) / static_cast<double>(radiance.size());
  return from;
}

PictureDifference picture_difference(const Picture& reference, const Picture& other) {
  if (reference.width != other.width || reference.height != other.height || reference.channels != other.channels) {
    throw usage_error("pictures of other sizes or channels cannot be compared");
  }
  PictureDifference d;
  const std::size_t channels = reference.channels.size();
  const std::vector<double> from = lit_from(reference.radiance, channels);
  double squares = 0.0;
  double differences = 0.0;
  double sum = 0.0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < reference.radiance.size(); ++i) {
    const double r = reference.radiance[i];
    if (!(r > from[i % channels])) continue;
    const double difference = std::fabs(other.radiance[i] - r);
    squares += difference * difference / (r * r);
    d.max_relative = std::max(d.max_relative, difference / r);
    differences += difference;
    sum += r;
    ++lit;
  }
  if (lit == 0) return d;
  d.rms_relative = std::sqrt(squares / static_cast<double>(lit));
  d.mean_relative = differences / sum;
  d.lit = static_cast<double>(lit) / static_cast<double>(reference.radiance.size());
  return d;
}

}  // namespace goniofit
