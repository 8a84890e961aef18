#pragma once
// Pictures as OpenEXR: 32-bit floats by channel, with words about them.

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace goniofit {

struct ExrImage {
  std::size_t width = 0, height = 0;
  std::vector<std::string> channels{};
  std::vector<std::vector<float>> values{};  ///< [channel][row * width + column], rows from the top
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< name and text; read back: those of this kind
};

/// Throws Error: bad_input for an image without channels or whose values are not as many as it says, system where the
/// file cannot be written. Values beyond the largest float are written as that.
void write_exr_image(const std::filesystem::path& path, const ExrImage& image);

/// All channels, of any of the format's types; the first part of several. Throws Error (bad_input) when there is no
/// such file, it is not a complete OpenEXR image, it is larger than 2^28 values, or a value is not finite.
[[nodiscard]] ExrImage read_exr_image(const std::filesystem::path& path);

}  // namespace goniofit
