#pragma once
// Directional-hemispherical reflectances: what a diffuse reflectometer reads beside a scan.

#include <cstddef>
#include <string>
#include <vector>

namespace goniofit {

struct ReflectanceChannel {
  std::string name;            ///< as the scan's
  std::vector<double> values;  ///< one a reading
  std::vector<double> u;       ///< their standard uncertainties; empty where there are none
};

/// Light from theta_i, at azimuth 0, reflected into the whole hemisphere, as a part of 1.
struct ReflectanceReadings {
  std::string source;
  std::vector<double> theta_i_deg;  ///< in [0, 90)
  std::vector<ReflectanceChannel> channels;

  [[nodiscard]] std::size_t size() const noexcept { return theta_i_deg.size(); }
};

}  // namespace goniofit
