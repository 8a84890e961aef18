#include "report/plan_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cost/tradeoff.h"
#include "report/fit_rows.h"
#include "report/material_json.h"
#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

std::string terms_text(const Terms& t) {
  return fmt::format("fresnel {}, shadowing {}, effective roughness {}, distribution {}", name_of(t.fresnel),
                     name_of(t.shadowing), name_of(t.effective_roughness), name_of(t.distribution));
}

std::string domain_text(const Domain& d) {
  std::string text = fmt::format("incidence {:.4g} to {:.4g}°, directions up to {:.4g}°", d.theta_i_min_deg,
                                 d.theta_i_max_deg, d.theta_r_max_deg);
  for (std::size_t i = 0; i < d.wavelengths_um.size(); ++i) {
    text += fmt::format("{}{:.4g}", i == 0 ? ", wavelengths " : ", ", d.wavelengths_um[i]);
  }
  if (!d.wavelengths_um.empty()) text += " µm";
  return text;
}

// Of a time over the plan's.
std::string against(double ratio) {
  if (std::fabs(ratio - 1.0) < 0.01) return "as fast as";
  return ratio > 1.0 ? fmt::format("{:.2f} times faster than", ratio)
                     : fmt::format("{:.2f} times slower than", 1.0 / ratio);
}

// Sums over effects and the whole differ by round-off.
std::string error_text(double e) { return e < 1e-12 ? "0 %" : percent_text(e); }

Json domain_json(const Domain& d) {
  return {{"theta_i_deg", {d.theta_i_min_deg, d.theta_i_max_deg}},
          {"theta_r_max_deg", d.theta_r_max_deg},
          {"wavelengths_um", d.wavelengths_um},
          {"solid_angle_sr", d.solid_angle_sr ? Json(*d.solid_angle_sr) : Json(nullptr)}};
}

Json line_json(const PlanLine& line) {
  return {{"subject", line.subject},
          {"choice", line.choice},
          {"instead", line.instead.empty() ? Json(nullptr) : Json(line.instead)},
          {"simplified", line.simplified},
          {"change", line.change},
          {"saves", line.saves},
          {"text", line.text()}};
}

}  // namespace

std::string plan_text(const Plan& p, const ReportStyle& style) {
  std::string out = tinted(printable(p.material.name), Tint::bold, style.color) + ": " +
                    effects_text(p.material.components) + "; " + terms_text(p.material.terms) + "\n";
  out += fmt::format("within {} on {}: L1 error of every incidence and channel{}, against {}\n\n",
                     percent_text(p.tolerance), domain_text(p.domain), p.bound_rms ? ", RMS relative error of all" : "",
                     printable(p.reference));
  for (const PlanLine& line : p.lines) {
    out += "  " + tinted(line.text(), line.simplified ? Tint::good : Tint::none, style.color) + "\n";
  }
  out += fmt::format("\nerror: L1 {}, at most {} at {:.3g}°; RMS relative {}, largest {}\n", error_text(p.error.l1),
                     error_text(p.error.worst_l1), p.error.worst_theta_i_deg, error_text(p.error.rms_relative),
                     error_text(p.error.max_relative));
  out += fmt::format("       of the material as given: L1 {}, at most {} at {:.3g}°\n", error_text(p.error_before.l1),
                     error_text(p.error_before.worst_l1), p.error_before.worst_theta_i_deg);
  out += fmt::format("time:  {:.3g} ns an evaluation, {} as given ({:.3g} ns), {} the reference ({:.3g} ns)\n", p.ns,
                     against(p.ratio_before), p.ns_before, against(p.ratio_reference), p.ns_reference);
  out += fmt::format("{} combinations, {} within the tolerance, {} of them timed\n", p.searched, p.within, p.timed);
  return out;
}

std::string plan_json(const Plan& p) {
  Json out{{"material", p.material.name},
           {"components", effect_names(p.material.components)},
           {"terms", terms_json(p.material.terms)},
           {"forms", {{"fs", name_of(p.material.forms.fs)}, {"rough", name_of(p.material.forms.rough)}}},
           {"reference", p.reference},
           {"tolerance", p.tolerance},
           {"bound_rms", p.bound_rms},
           {"domain", domain_json(p.domain)},
           {"l1_error", p.error.l1},
           {"worst_l1_error", p.error.worst_l1},
           {"worst_l1_bound", p.error.worst_l1_bound},
           {"worst_theta_i_deg", p.error.worst_theta_i_deg},
           {"rms_relative_error", p.error.rms_relative},
           {"max_relative_error", p.error.max_relative},
           {"l1_error_before", p.error_before.l1},
           {"worst_l1_error_before", p.error_before.worst_l1},
           {"ns_per_evaluation", p.ns},
           {"ns_before", p.ns_before},
           {"ns_reference", p.ns_reference},
           {"ratio_before", p.ratio_before},
           {"ratio_reference", p.ratio_reference},
           {"searched", p.searched},
           {"within_tolerance", p.within},
           {"timed", p.timed}};
  out["lines"] = Json::array();
  for (const PlanLine& line : p.lines) out["lines"].push_back(line_json(line));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
