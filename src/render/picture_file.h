#pragma once
// Rendered pictures as files.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer.h"

namespace goniofit {

/// What a picture's file says of it, by name.
using PictureNotes = std::vector<std::pair<std::string, std::string>>;

/// ".exr": linear 32-bit floats, R, G, B of linear sRGB (color.h), attributes named as the notes are ("goniofit.plan").
/// Where there are more than three channels, all with wavelengths, they stand beside these as a spectral image (Fichet,
/// Pacanowski & Wilkie 2021): "S0.450,000000nm", attributes spectralLayoutVersion and emissiveUnits.
/// ".png": for screens (color.h), at `exposure_stops` or by the picture itself; the notes as texts.
/// Whole or not at all. Throws Error: bad_input for another ending, system where the file cannot be written.
void write_picture(const std::filesystem::path& path, const Picture& picture, std::optional<double> exposure_stops,
                   const PictureNotes& notes = {});

/// Throws Error (bad_input) for an ending that write_picture does not know.
void expect_picture_name(const std::filesystem::path& path);

/// Pictures of the same height and channels, from left to right.
[[nodiscard]] Picture side_by_side(const std::vector<Picture>& pictures);

}  // namespace goniofit
