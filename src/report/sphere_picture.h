#pragma once
// A sphere of a material, as a picture to recognise it by.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../brdf/material.h"

namespace goniofit {

/// Which channels stand for red, green and blue, and what a caption says of it.
struct PictureBands {
  std::array<std::size_t, 3> channel{};
  std::string text;  ///< "R, G, B"; "650nm, 550nm and 450nm as red, green and blue"; "R as grey"
};
[[nodiscard]] PictureBands picture_bands(const Material& material);

struct SpherePicture {
  std::size_t size = 0;           ///< pixels a side
  std::vector<std::uint8_t> rgb;  ///< row by row from the top, sRGB
  PictureBands bands;
  /// Exposure, as a multiple of the one that draws a white diffuser facing the light as full white.
  double exposure = 1.0;
};

/// An orthographic view of a sphere on grey under one directional light from the upper left, no light from elsewhere.
/// Radiance is f cos(theta_i). Brightness is set so that nine tenths of the lit part lie below full white; highlights
/// above are compressed (Reinhard et al. 2002, eq. 4). An anisotropic surface has its x axis along the meridians.
/// Deterministic. Throws Error (bad_input) for a material that is not valid.
[[nodiscard]] SpherePicture sphere_picture(const Material& material, std::size_t size = 288);

/// The material with terms in which a picture or a surface of many thousand values takes no minutes: the sum of
/// He et al. by its expansion (within 3e-10), the integral over grooves by its functional form (2 % in the mean).
[[nodiscard]] Material quickly_drawn(Material material);

}  // namespace goniofit
