#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "report/scan_statistics.h"

namespace goniofit {

namespace {

constexpr double near_deg = 2.0;      // a lobe narrower than this would hide between readings
constexpr double grazing_deg = 75.0;  // below it, forward scattering and shadowing hardly show
constexpr double wide_azimuth_gap_deg = 30.0;
constexpr double reciprocity_tolerance = 0.1;
constexpr std::size_t most_listed = 6;

std::string angle(double degrees) { return fmt::format("{:.4g}°", degrees); }

std::string list_of(const std::vector<double>& angles) {
  std::string out;
  for (std::size_t i = 0; i < std::min(angles.size(), most_listed); ++i) out += (i == 0 ? "" : ", ") + angle(angles[i]);
  return angles.size() > most_listed ? out + fmt::format(" and {} more", angles.size() - most_listed) : out;
}

// Incidence angles whose mirror (or retro) direction has no reading near.
std::vector<double> uncovered(const ScanStatistics& s, double IncidenceStatistics::*nearest) {
  std::vector<double> angles;
  for (const IncidenceStatistics& incidence : s.incidences) {
    if (incidence.*nearest > near_deg) angles.push_back(incidence.theta_i_deg);
  }
  return angles;
}

void note_uncovered(const ScanStatistics& s, const char* name, double IncidenceStatistics::*nearest,
                    std::vector<std::string>& notes) {
  const std::vector<double> angles = uncovered(s, nearest);
  if (angles.empty()) return;
  if (angles.size() < s.incidences.size()) {
    notes.push_back(
        fmt::format("no reading within {} of the {} direction at θᵢ = {}", angle(near_deg), name, list_of(angles)));
    return;
  }
  double closest = 180.0;
  for (const IncidenceStatistics& incidence : s.incidences) closest = std::min(closest, incidence.*nearest);
  notes.push_back(fmt::format("no reading within {} of the {} direction at any θᵢ (nearest {})", angle(near_deg), name,
                              angle(closest)));
}

void note_coverage(const Scan& scan, const ScanStatistics& s, std::vector<std::string>& notes) {
  note_uncovered(s, "mirror", &IncidenceStatistics::nearest_mirror_deg, notes);
  note_uncovered(s, "retro", &IncidenceStatistics::nearest_retro_deg, notes);
  const double theta_r_max = *std::max_element(scan.theta_r_deg.begin(), scan.theta_r_deg.end());
  if (s.theta_i_deg.max < grazing_deg) notes.push_back("no grazing incidence: θᵢ ends at " + angle(s.theta_i_deg.max));
  if (theta_r_max < grazing_deg) notes.push_back("no grazing reflection: θᵣ ends at " + angle(theta_r_max));
  if (scan.geometry == ScanGeometry::incidence_plane && s.retro == 0) notes.emplace_back("forward side only");
  if (scan.geometry == ScanGeometry::incidence_plane && s.forward == 0) notes.emplace_back("retro side only");
  if (s.azimuth_gap && s.azimuth_gap->to_deg - s.azimuth_gap->from_deg > wide_azimuth_gap_deg) {
    notes.push_back(fmt::format("no reading at |Δφ| between {} and {}", angle(s.azimuth_gap->from_deg),
                                angle(s.azimuth_gap->to_deg)));
  }
}

void note_values(const Scan& scan, const ScanStatistics& s, std::vector<std::string>& notes) {
  std::size_t negative = 0;
  std::size_t zero = 0;
  std::size_t not_reciprocal = 0;
  for (const ChannelStatistics& channel : s.channels) {
    negative += channel.negative;
    zero += channel.zero;
    const double median = channel.reciprocity ? channel.reciprocity->median : 1.0;
    not_reciprocal += std::max(median, 1.0 / median) > 1.0 + reciprocity_tolerance ? 1 : 0;
  }
  const std::size_t values = scan.size() * scan.channels.size();
  if (negative > 0)
    notes.push_back(fmt::format("{} of {} values are negative; they are kept as noise", negative, values));
  if (zero > 0) notes.push_back(fmt::format("{} of {} values are exactly 0, clamped perhaps", zero, values));
  if (s.at_horizon > 0)
    notes.push_back(fmt::format("{} of {} readings are at θ = 90°; fits leave them out", s.at_horizon, scan.size()));
  if (not_reciprocal > 0) {
    notes.push_back(fmt::format("swapped directions differ by more than {:.0f} % in {} of {} channels (median)",
                                100.0 * reciprocity_tolerance, not_reciprocal, scan.channels.size()));
  }
}

}  // namespace

std::vector<std::string> scan_notes(const Scan& scan, const ScanStatistics& statistics) {
  std::vector<std::string> notes;
  note_coverage(scan, statistics, notes);
  note_values(scan, statistics, notes);
  return notes;
}

}  // namespace goniofit
