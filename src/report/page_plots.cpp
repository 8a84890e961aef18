#include "report/page_plots.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "brdf/azimuths.h"
#include "brdf/batch_evaluator.h"
#include "geometry/angles.h"
#include "report/digest.h"
#include "report/fit_rows.h"
#include "report/lobe_grid.h"
#include "report/number_text.h"
#include "report/plot_plan.h"
#include "report/residual_plan.h"
#include "report/sphere_picture.h"
#include "support/error.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::size_t>;

// What keeps a page below four megabytes.
constexpr std::size_t most_map_values = 60'000, most_curve_values = 40'000;  // readings times channels
constexpr std::size_t most_channels = 32, most_lobe_channels = 6;
constexpr std::size_t most_incidences = 12, most_lobes = 8;
constexpr std::size_t many_channels = 8;  // with more, eight incidence angles of curves
// A mirror's spike on a plot ends here, in units of the largest reading.
constexpr double spike = 1e3;

class Plots {
 public:
  Plots(const FitResult& result, const Scan& scan)
      : result_(result),
        scan_(scan),
        evaluator_(result.material),
        anisotropic_(scan.size() > 0 && is_anisotropic(Evaluator(result.material))),
        channels_(evenly_chosen(scan.channels.size(), most_channels)),
        shown_(scan),
        rows_(scan.size()) {
    std::iota(rows_.begin(), rows_.end(), std::size_t{0});
    if (anisotropic_) {
      shown_ = at_azimuth(scan, first_azimuth());
      rows_ = rows_at_azimuth(scan, first_azimuth());
    }
    std::vector<AnglePair> angles;
    for (std::size_t row = 0; row < scan.size(); ++row) angles.push_back(scan.angles(row));
    fitted_ = values(evaluator_, angles);
    for (const ScanChannel& channel : scan.channels) {
      for (const double value : channel.values) highest_ = std::max(highest_, value);
    }
    if (!(highest_ > 0.0)) highest_ = 1.0;
  }
  [[nodiscard]] Json all() const;

 private:
  [[nodiscard]] std::vector<double> values(const BatchEvaluator<double>& evaluator,
                                           const std::vector<AnglePair>& angles) const {
    std::vector<double> out(angles.size() * evaluator.channels());
    evaluator.values(PairBatch(angles), out);
    return out;
  }
  [[nodiscard]] double measured(std::size_t channel, std::size_t row) const {
    return scan_.channels[channel].values[row];
  }
  [[nodiscard]] double fitted(std::size_t channel, std::size_t row) const {
    return std::min(fitted_[channel * scan_.size() + row], spike * highest_);
  }
  /// What of `readings` can be kept in a part of the page; values with uncertainties take half as much again.
  [[nodiscard]] double kept_part(std::size_t readings, std::size_t most) const {
    const bool with_u =
        std::any_of(scan_.channels.begin(), scan_.channels.end(), [](const ScanChannel& c) { return !c.u.empty(); });
    const auto values =
        static_cast<double>(std::max<std::size_t>(1, readings * channels_.size())) * (with_u ? 1.5 : 1.0);
    return std::min(1.0, static_cast<double>(most) / values);
  }
  [[nodiscard]] Json channel_of(const std::vector<double>& all, std::size_t channel) const;
  [[nodiscard]] Json series(const Rows& rows) const;
  [[nodiscard]] Json channels() const;
  [[nodiscard]] Json curves() const;
  [[nodiscard]] Json curve(const PlotPlan& plan, const PlottedIncidence& incidence) const;
  [[nodiscard]] Json maps() const;
  [[nodiscard]] Json lobes(const std::vector<ResidualPanel>& panels) const;
  [[nodiscard]] Json lobe(const BatchEvaluator<double>& evaluator, double theta_i_deg, const Rows& channels) const;
  [[nodiscard]] Json residual() const;
  [[nodiscard]] double first_azimuth() const { return anisotropic_ ? scan_.phi_i_deg.front() : 0.0; }

  const FitResult& result_;
  const Scan& scan_;
  BatchEvaluator<double> evaluator_;
  bool anisotropic_;
  Rows channels_;  // shown
  // What an anisotropic material does at one azimuth says nothing of the readings at another: those of the first alone.
  Scan shown_;
  Rows rows_;                   // of the scan, one a reading of shown_
  std::vector<double> fitted_;  // [channel * readings + reading]
  double highest_ = 0.0;        // reading
};

Json array_of(const std::vector<double>& values) { return base64_floats(values); }

template <class Value>
Json column(const Rows& rows, Value&& value) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) out.push_back(value(row));
  return array_of(out);
}

std::string kept_text(double part) { return percent_text(part) + " of the readings, evenly chosen"; }

std::size_t part_of(std::size_t count, double part) {
  return static_cast<std::size_t>(std::ceil(part * static_cast<double>(count)));
}

// One channel of what values() gives.
Json Plots::channel_of(const std::vector<double>& all, std::size_t channel) const {
  const auto size = static_cast<std::ptrdiff_t>(all.size() / scan_.channels.size());
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(channel) * size;
  std::vector<double> one(first, first + size);
  for (double& f : one) f = std::min(f, spike * highest_);
  return array_of(one);
}

// Measured, fitted and u of some readings, channel by channel.
Json Plots::series(const Rows& rows) const {
  Json out = Json::array();
  for (const std::size_t c : channels_) {
    Json one;
    one["measured"] = column(rows, [&](std::size_t row) { return measured(c, row); });
    one["fitted"] = column(rows, [&](std::size_t row) { return fitted(c, row); });
    const std::vector<double>& u = scan_.channels[c].u;
    if (!u.empty()) one["u"] = column(rows, [&](std::size_t row) { return u[row]; });
    out.push_back(std::move(one));
  }
  return out;
}

Json Plots::channels() const {
  Json out = Json::array();
  for (const std::size_t c : channels_) out.push_back(scan_.channels[c].name);
  return out;
}

Json Plots::curve(const PlotPlan& plan, const PlottedIncidence& incidence) const {
  std::vector<double> angles = curve_angles(plan, incidence.theta_i_deg, lobe_width_deg(result_.material));
  std::vector<AnglePair> pairs;
  for (const double angle : angles) {
    AnglePair pair = in_plane(incidence.theta_i_deg, angle);
    pair.phi_i_deg += plan.phi_i_deg.value_or(0.0);
    pair.phi_r_deg += plan.phi_i_deg.value_or(0.0);
    pairs.push_back(pair);
  }
  const std::vector<double> all = values(evaluator_, pairs);
  Json out;
  out["theta_i"] = incidence.theta_i_deg;
  out["theta_r"] = array_of(incidence.signed_theta_r_deg);
  out["channels"] = series(incidence.rows);
  out["curve_theta_r"] = array_of(angles);
  out["curve"] = Json::array();
  for (const std::size_t c : channels_) out["curve"].push_back(channel_of(all, c));
  return out;
}

Json Plots::curves() const {
  Json out;
  out["incidences"] = Json::array();
  PlotPlan plan;
  try {
    plan = plan_plot(shown_, {.axis = PlotAxis::automatic,
                              .max_panels = most_channels,
                              .max_incidences = channels_.size() > many_channels ? most_lobes : most_incidences});
  } catch (const Error&) {
    out["note"] = "The scan has no readings within 10° of the plane of incidence.";
    return out;
  }
  if (anisotropic_) plan.phi_i_deg = first_azimuth();
  out["log"] = plan.log;
  out["theta_r_range"] = {plan.theta_min_deg, plan.theta_max_deg};
  plan.not_shown = 0;  // the page's reader chooses the axis
  std::string note = plot_remarks(plan);
  std::size_t readings = 0;
  for (const PlottedIncidence& incidence : plan.incidences) readings += incidence.rows.size();
  const double kept = kept_part(readings, most_curve_values);
  if (kept < 1.0) note += (note.empty() ? "" : "; ") + kept_text(kept);
  out["note"] = note;
  for (const PlottedIncidence& incidence : plan.incidences) {
    PlottedIncidence part{incidence.theta_i_deg, {}, {}};
    for (const std::size_t i : evenly_chosen(incidence.rows.size(), part_of(incidence.rows.size(), kept))) {
      part.rows.push_back(rows_[incidence.rows[i]]);
      part.signed_theta_r_deg.push_back(incidence.signed_theta_r_deg[i]);
    }
    out["incidences"].push_back(curve(plan, part));
  }
  return out;
}

Json panel_json(const ResidualPanel& panel, const Scan& scan, const Rows& rows) {
  Json out;
  out["theta_i"] = panel.theta_i_deg;
  out["theta_i_high"] = panel.theta_i_high_deg;
  out["theta_r"] = column(rows, [&](std::size_t row) { return scan.theta_r_deg[row]; });
  // Where the mirror direction is, is 180° on every scan.
  out["phi"] = column(rows, [&](std::size_t row) { return wrap_deg(scan.phi_r_deg[row] - scan.phi_i_deg[row]); });
  return out;
}

Json Plots::maps() const {
  const std::vector<ResidualPanel> panels = incidence_panels(shown_, most_incidences);
  std::size_t readings = 0;
  std::size_t out_of_plane = 0;
  for (const ResidualPanel& panel : panels) {
    for (const std::size_t row : panel.rows) out_of_plane += shown_.plane_side(row) == 0 ? 1 : 0;
    readings += panel.rows.size();
  }
  const double kept = kept_part(readings, most_map_values);
  Json out;
  out["available"] = 5 * out_of_plane > readings;
  out["panels"] = Json::array();
  for (const ResidualPanel& panel : panels) {
    Rows rows;
    for (const std::size_t i : evenly_chosen(panel.rows.size(), part_of(panel.rows.size(), kept)))
      rows.push_back(rows_[panel.rows[i]]);
    Json one = panel_json(panel, scan_, rows);
    one["channels"] = series(rows);
    out["panels"].push_back(std::move(one));
  }
  std::string note = anisotropic_ ? fmt::format("φᵢ = {}° alone", angle_text(first_azimuth())) : std::string();
  if (kept < 1.0) note += (note.empty() ? "" : "; ") + kept_text(kept);
  out["note"] = note;
  return out;
}

Json Plots::lobe(const BatchEvaluator<double>& evaluator, double theta_i_deg, const Rows& channels) const {
  const auto [theta, phi] = lobe_grid(theta_i_deg, lobe_width_deg(result_.material), anisotropic_);
  std::vector<AnglePair> pairs;
  for (const double t : theta) {
    for (const double p : phi) pairs.push_back({theta_i_deg, first_azimuth(), t, first_azimuth() + p});
  }
  const std::vector<double> all = values(evaluator, pairs);
  Json out;
  out["theta_i"] = theta_i_deg;
  out["theta"] = array_of(theta);
  out["phi"] = array_of(phi);
  out["values"] = Json::array();
  for (const std::size_t c : channels) out["values"].push_back(channel_of(all, c));
  return out;
}

// At the maps' incidence angles, so that their readings can be drawn with them.
Json Plots::lobes(const std::vector<ResidualPanel>& panels) const {
  const BatchEvaluator<double> evaluator(quickly_drawn(result_.material), {.tolerance = 1e-4});
  Rows of_shown = evenly_chosen(channels_.size(), most_lobe_channels);
  Rows channels;
  for (const std::size_t i : of_shown) channels.push_back(channels_[i]);
  Json out;
  out["channels"] = of_shown;  // indices into the channels shown
  out["panels"] = evenly_chosen(panels.size(), most_lobes);
  out["lobes"] = Json::array();
  for (const std::size_t p : evenly_chosen(panels.size(), most_lobes)) {
    out["lobes"].push_back(lobe(evaluator, 0.5 * (panels[p].theta_i_deg + panels[p].theta_i_high_deg), channels));
  }
  return out;
}

Json Plots::residual() const {
  Json out;
  out["by_u"] =
      std::all_of(channels_.begin(), channels_.end(), [&](std::size_t c) { return !scan_.channels[c].u.empty(); });
  out["floor"] = residual_floor(scan_, result_, channels_);
  return out;
}

Json Plots::all() const {
  Json out;
  out["channels"] = channels();
  if (channels_.size() < scan_.channels.size()) {
    out["note"] = fmt::format("{} of {} channels are drawn", channels_.size(), scan_.channels.size());
  }
  out["anisotropic"] = anisotropic_;
  out["residual"] = residual();
  out["curves"] = curves();
  out["maps"] = maps();
  out["lobes"] = lobes(incidence_panels(shown_, most_incidences));
  return out;
}

}  // namespace

Json page_plots(const FitResult& result, const Scan& scan) { return Plots(result, scan).all(); }

}  // namespace goniofit
