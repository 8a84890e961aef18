#pragma once
// Bytes as the text that a page needs of them.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace goniofit {

/// SHA-256 of a file in lower-case hexadecimal, as `sha256sum` prints it. Throws Error (system) where it cannot be
/// read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);
/// The values as 32-bit floats, little-endian.
[[nodiscard]] std::string base64_floats(std::span<const double> values);

}  // namespace goniofit
