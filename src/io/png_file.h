#pragma once
// Pictures as PNG: 8-bit RGB, sRGB-encoded by the caller.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace goniofit {

/// Rows from the top, three bytes a pixel: bytes[3 * (row * width + column) + channel].
struct RgbPicture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

/// sRGB's curve of a linear value, in a byte; beyond 0 and 1 as they.
[[nodiscard]] std::uint8_t srgb_byte(double linear) noexcept;

/// Keyword (Latin letters, at most 79) and text (UTF-8) of the chunks that say what a picture is.
using PictureTexts = std::vector<std::pair<std::string, std::string>>;

/// The file's bytes, the same for the same picture. Throws Error: bad_input for a picture that is empty, whose bytes
/// are not 3 width height, or with a keyword that PNG does not allow; system where memory ends.
[[nodiscard]] std::string to_png(const RgbPicture& picture, const PictureTexts& texts = {});

/// Whole or not at all (support/output_file.h). Throws Error as to_png, and system where the file cannot be written.
void write_png(const std::filesystem::path& path, const RgbPicture& picture, const PictureTexts& texts = {});

}  // namespace goniofit
