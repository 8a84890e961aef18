#pragma once
// A small picture as the bytes of a PNG file.

#include <cstdint>
#include <span>
#include <string>

namespace goniofit {

/// `rgb` has 3 * width * height elements, row by row from the top, sRGB. Throws Error (system) where libpng fails.
[[nodiscard]] std::string png_of_rgb(std::size_t width, std::size_t height, std::span<const std::uint8_t> rgb);

}  // namespace goniofit
