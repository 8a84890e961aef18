#pragma once
// Directional-hemispherical reflectances as CSV:
//
//   theta_i,R,G,B            degrees in [0, 90); parts of 1
//   theta_i,R,G,B,u_R,u_G,u_B  with their standard uncertainties, finite and above 0
//
// Columns in any order and any case; every name but theta_i and u_<channel> is a channel. Values from 0 to 1, a little
// more being allowed to noise: up to 1.1.

#include <filesystem>
#include <istream>
#include <string>

#include "../scan/reflectance_readings.h"

namespace goniofit {

/// Throws Error (bad_input) as "FILE:LINE: column NAME: what is wrong, what was expected", also for uncertainties of
/// only some channels' own columns, names given twice, and a file without a row.
[[nodiscard]] ReflectanceReadings read_reflectances(const std::filesystem::path& path);
[[nodiscard]] ReflectanceReadings read_reflectances(std::istream& in, const std::string& source);

}  // namespace goniofit
