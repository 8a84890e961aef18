#include "scan/scan.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "geometry/angles.h"
#include "support/error.h"

namespace goniofit {

namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

// "450", "450nm" and "450.0 NM" are one name: what is a number of nanometres is compared as one.
std::optional<double> nanometres(std::string_view lower_name) {
  if (lower_name.ends_with("nm")) lower_name.remove_suffix(2);
  while (lower_name.ends_with(' ')) lower_name.remove_suffix(1);
  double value = 0.0;
  const char* const end = lower_name.data() + lower_name.size();
  const auto [rest, status] = fast_float::from_chars(lower_name.data(), end, value);
  if (status != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool same_channel_name(const std::string& a, const std::string& b) {
  const std::string lower_a = lower(a);
  const std::string lower_b = lower(b);
  if (lower_a == lower_b) return true;
  const std::optional<double> number_a = nanometres(lower_a);
  return number_a && number_a == nanometres(lower_b);
}

std::string channel_list(const std::vector<ScanChannel>& channels) {
  std::string out;
  for (const ScanChannel& channel : channels) out += (out.empty() ? "" : ", ") + channel.name;
  return out;
}

std::size_t find_channel(const Scan& scan, const std::string& name) {
  const auto found = std::find_if(scan.channels.begin(), scan.channels.end(),
                                  [&](const ScanChannel& c) { return same_channel_name(c.name, name); });
  if (found == scan.channels.end()) {
    throw input_error(scan.source, 0, "", "no channel '" + name + "'; there are " + channel_list(scan.channels));
  }
  return static_cast<std::size_t>(found - scan.channels.begin());
}

void append(std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); }

// What several scans say of one quantity: those that say anything must agree.
void merge(std::optional<double>& to, const std::optional<double>& from, const Scan& scan, const std::string& column,
           const std::string& quantity) {
  if (!to) to = from;
  if (from && to != from) {
    throw input_error(scan.source, 0, column,
                      quantity + " differs from that of the scans before it; expected the same");
  }
}

void append_channel(ScanChannel& to, const ScanChannel& from, const Scan& scan) {
  if (to.u.empty() != from.u.empty()) {
    throw input_error(scan.source, 0, from.name,
                      std::string(from.u.empty() ? "has no" : "has a") + " u_" + from.name +
                          " column unlike the scans before it; expected uncertainties in all of them or in none");
  }
  merge(to.wavelength_um, from.wavelength_um, scan, from.name, "wavelength_um");
  merge(to.n, from.n, scan, from.name, "refractive_index");
  merge(to.kappa, from.kappa, scan, from.name, "refractive_index");
  append(to.values, from.values);
  append(to.u, from.u);
}

void append_scan(Scan& to, const Scan& from) {
  const bool same =
      std::equal(to.channels.begin(), to.channels.end(), from.channels.begin(), from.channels.end(),
                 [](const ScanChannel& a, const ScanChannel& b) { return same_channel_name(a.name, b.name); });
  if (!same) {
    throw input_error(from.source, 0, "",
                      "channels " + channel_list(from.channels) + "; expected " + channel_list(to.channels) +
                          " as in the scans before it");
  }
  merge(to.solid_angle_sr, from.solid_angle_sr, from, "", "solid_angle_sr");
  merge(to.scale_u, from.scale_u, from, "", "scale_u");
  for (std::size_t c = 0; c < to.channels.size(); ++c) append_channel(to.channels[c], from.channels[c], from);
  append(to.theta_i_deg, from.theta_i_deg);
  append(to.phi_i_deg, from.phi_i_deg);
  append(to.theta_r_deg, from.theta_r_deg);
  append(to.phi_r_deg, from.phi_r_deg);
  // In-plane rows are a special case of hemispherical ones, never the other way round.
  if (from.geometry == ScanGeometry::hemispherical) to.geometry = ScanGeometry::hemispherical;
  to.source += ", " + from.source;
}

}  // namespace

int Scan::plane_side(std::size_t row, double tolerance_deg) const noexcept {
  if (theta_i_deg[row] == 0.0 || theta_r_deg[row] == 0.0) return 1;
  const double delta = std::fabs(wrap_deg(phi_r_deg[row] - phi_i_deg[row]));
  if (180.0 - delta <= tolerance_deg) return 1;
  return delta <= tolerance_deg ? -1 : 0;
}

double Scan::signed_theta_r_deg(std::size_t row) const noexcept { return plane_side(row) * theta_r_deg[row]; }

Scan select_channels(const Scan& scan, const std::vector<std::string>& names) {
  if (names.empty()) return scan;
  std::vector<std::size_t> chosen;
  std::set<std::size_t> seen;
  for (const std::string& name : names) {
    chosen.push_back(find_channel(scan, name));
    if (!seen.insert(chosen.back()).second) {
      throw input_error(scan.source, 0, "", "channel " + scan.channels[chosen.back()].name + " is asked for twice");
    }
  }
  Scan out{.source = scan.source,
           .name = scan.name,
           .geometry = scan.geometry,
           .theta_i_deg = scan.theta_i_deg,
           .phi_i_deg = scan.phi_i_deg,
           .theta_r_deg = scan.theta_r_deg,
           .phi_r_deg = scan.phi_r_deg,
           .channels = {},
           .solid_angle_sr = scan.solid_angle_sr,
           .scale_u = scan.scale_u,
           .metadata = scan.metadata};
  for (const std::size_t c : chosen) out.channels.push_back(scan.channels[c]);
  return out;
}

Scan concatenate(const std::vector<Scan>& scans) {
  if (scans.empty()) throw usage_error("no scan is given");
  Scan out = scans.front();
  for (std::size_t i = 1; i < scans.size(); ++i) append_scan(out, scans[i]);
  return out;
}

}  // namespace goniofit
