#include <nlohmann/json.hpp>

#include "report/fit_report.h"
#include "report/fit_rows.h"
#include "report/scan_statistics.h"

namespace goniofit {

namespace {

using Json = nlohmann::ordered_json;

Json range_json(const ValueRange& range) { return Json::array({range.min, range.max}); }

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json incidence_json(const IncidenceStatistics& i) {
  return {{"theta_i_deg", i.theta_i_deg},
          {"readings", i.readings},
          {"theta_r_deg", range_json(i.theta_r_deg)},
          {"nearest_mirror_deg", i.nearest_mirror_deg},
          {"nearest_retro_deg", i.nearest_retro_deg}};
}

Json reciprocity_json(const std::optional<RatioStatistics>& ratio) {
  if (!ratio) return nullptr;
  return {{"median", ratio->median}, {"inner_90", range_json(ratio->inner_90)}};
}

Json channel_json(const ScanChannel& channel, const ChannelStatistics& t) {
  return {{"name", channel.name},
          {"wavelength_um", value_or_null(channel.wavelength_um)},
          {"n", value_or_null(channel.n)},
          {"kappa", value_or_null(channel.kappa)},
          {"value", range_json(t.value)},
          {"median", t.median},
          {"negative", t.negative},
          {"zero", t.zero},
          {"has_uncertainty", !channel.u.empty()},
          {"median_relative_uncertainty", value_or_null(t.relative_u)},
          {"reciprocity", reciprocity_json(t.reciprocity)},
          {"repeat_spread", value_or_null(t.repeat_spread)}};
}

Json coverage_json(const ScanStatistics& s) {
  Json out{{"in_plane_forward", s.forward}, {"in_plane_retro", s.retro}, {"left", s.left}, {"right", s.right},
           {"at_90_deg", s.at_horizon},     {"azimuth_gap_deg", nullptr}};
  if (s.azimuth_gap) out["azimuth_gap_deg"] = Json::array({s.azimuth_gap->from_deg, s.azimuth_gap->to_deg});
  return out;
}

}  // namespace

std::string scan_summary_json(const Scan& scan) {
  const ScanStatistics s = scan_statistics(scan);
  Json out{{"source", scan.source},
           {"name", scan.name},
           {"geometry", geometry_name(scan.geometry)},
           {"readings", scan.size()},
           {"theta_i_deg", range_json(s.theta_i_deg)},
           {"theta_r_deg", range_json(s.theta_r_deg)},
           {"solid_angle_sr", value_or_null(scan.solid_angle_sr)},
           {"coverage", coverage_json(s)},
           {"reciprocal_pairs", s.reciprocal_pairs},
           {"repeated_directions", s.repeated_directions},
           {"repeated_readings", s.repeated_readings}};
  out["metadata"] = Json::object();
  for (const auto& [key, value] : scan.metadata) out["metadata"][key] = value;
  out["incidences"] = Json::array();
  for (const IncidenceStatistics& incidence : s.incidences) out["incidences"].push_back(incidence_json(incidence));
  out["channels"] = Json::array();
  for (std::size_t c = 0; c < scan.channels.size(); ++c)
    out["channels"].push_back(channel_json(scan.channels[c], s.channels[c]));
  out["notes"] = scan_notes(scan, s);
  // Names and metadata come from files: bytes that are no UTF-8 are replaced, not thrown at the reader.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
