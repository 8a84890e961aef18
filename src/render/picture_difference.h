#pragma once
// How far one picture is off another.

#include "renderer.h"

namespace goniofit {

/// Over the lit values of the reference: a channel of a pixel above 1/100 of the channel's mean over all pixels.
struct PictureDifference {
  double rms_relative = 0.0;  ///< root of the mean of (difference / reference)²
  double max_relative = 0.0;
  double mean_relative = 0.0;  ///< sum of |difference| over the sum of the reference
  double lit = 0.0;            ///< part of the values that are lit
};

/// Throws Error (bad_input) for pictures of other sizes or channels.
[[nodiscard]] PictureDifference picture_difference(const Picture& reference, const Picture& other);

/// From where on a channel counts as lit.
[[nodiscard]] std::vector<double> lit_from(std::span<const double> radiance, std::size_t channels);

}  // namespace goniofit
