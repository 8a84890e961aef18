#include "report/profile_report.h"

#include <cmath>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/fit_rows.h"
#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

std::string limit_text(double limit, double u) {
  if (std::isinf(limit)) return limit > 0.0 ? "∞" : "−∞";
  if (limit == 0.0) return "0";
  return u > 0.0 ? value_text(limit, u).value : number_text(limit);
}

// "[0.0851, 0.0856]", to what u supports.
std::string interval_text(const std::optional<Interval>& interval, const std::optional<double>& u) {
  if (!interval) return "–";
  // Limits are worth no more digits than u; where there is none, the interval itself is the measure.
  const double width = interval->upper - interval->lower;
  const double measure = u ? *u : std::isfinite(width) ? 0.1 * width : 0.0;
  return "[" + limit_text(interval->lower, measure) + ", " + limit_text(interval->upper, measure) + "]";
}

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return Json::array({number_json(interval->lower), number_json(interval->upper)});
}

const char* name_of(ProfileEnd end) {
  return end == ProfileEnd::crossed ? "crossed" : end == ProfileEnd::bound ? "bound" : "open";
}

Json profile_json(const LikelihoodProfile& p) {
  Json out;
  out["name"] = p.name;
  out["channel"] = p.channel.empty() ? Json(nullptr) : Json(p.channel);
  out["unit"] = p.unit;
  out["value"] = p.determined ? number_json(p.value) : Json(nullptr);
  out["standard_uncertainty"] = p.u ? number_json(*p.u) : Json(nullptr);
  out["coverage_factor"] = p.coverage_factor;
  out["scale"] = p.scale;
  out["interval_95_by_u"] = interval_json(p.interval_by_u);
  out["interval_68"] = interval_json(p.interval_68);
  out["interval_95"] = interval_json(p.interval_95);
  out["ends"] = {name_of(p.lower_end), name_of(p.upper_end)};
  out["remark"] = p.remark();
  out["searched"] = p.searched;
  out["points"] = Json::array();
  for (const ProfilePoint& at : p.points)
    out["points"].push_back({{"value", at.value}, {"loss", number_json(at.loss)}, {"delta", number_json(at.delta)}});
  return out;
}

}  // namespace

std::string profile_block(const std::vector<LikelihoodProfile>& profiles, bool color) {
  using Align = TextTable::Align;
  TextTable table({{"parameter", Align::left},
                   {"value", Align::right},
                   {"u", Align::left},
                   {"95 % by u", Align::left},
                   {"95 % by profile", Align::left},
                   {"unit", Align::left},
                   {"", Align::left}});
  for (const LikelihoodProfile& p : profiles) {
    std::string value = p.determined ? number_text(p.value) : "–";
    std::string u;
    if (p.u && p.determined) {
      const ValueText text = value_text(p.value, *p.u);
      value = text.value;
      u = "± " + text.uncertainty;
    }
    table.add_row({printable(p.key()),
                   value,
                   u,
                   interval_text(p.interval_by_u, p.u),
                   interval_text(p.interval_95, p.u),
                   unit_text(p.unit),
                   {p.remark(), Tint::warning}});
  }
  return table.str(2, color) +
         tinted("  (likelihood with all other parameters refitted, its curvature adjusted to u; by u: value ± k u)\n",
                Tint::faint, color);
}

Json profiles_json(const std::vector<LikelihoodProfile>& profiles) {
  Json out = Json::array();
  for (const LikelihoodProfile& p : profiles) out.push_back(profile_json(p));
  return out;
}

}  // namespace goniofit
