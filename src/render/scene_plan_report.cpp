#include "render/scene_plan_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cost/tradeoff.h"
#include "io/material_io.h"
#include "report/number_text.h"
#include "report/plan_report.h"
#include "report/text_table.h"

namespace goniofit {

namespace {

using Json = nlohmann::ordered_json;
using Align = TextTable::Align;

std::string angles_text(const Domain& d) {
  return fmt::format("lit at {}° to {}°, seen at up to {}°", angle_text(d.theta_i_min_deg),
                     angle_text(d.theta_i_max_deg), angle_text(d.theta_r_max_deg));
}

std::string bounces_text(const BouncePlan& b) {
  if (b.given == 1) return "light is followed for 1 reflection, as the scene asks";
  if (b.planned == b.given) {
    return fmt::format("light is followed for {} reflections: the last left out would change {}", b.given,
                       percent_text(b.change));
  }
  return fmt::format("light after {} reflection{} left out, of {}: changes {}, saves {}", b.planned,
                     b.planned == 1 ? "" : "s", b.given, percent_text(b.change), percent_text(b.saves));
}

std::string simpler_terms_text(const Plan& p) {
  std::string text;
  for (const PlanLine& line : p.lines) {
    const bool term = line.simplified && line.choice != "left out" && line.choice != "none";
    if (term) text += (text.empty() ? "" : ", ") + line.choice + " for " + line.instead;
  }
  return text;
}

// Empty where no other surface sends light to it.
std::string interreflection_text(const MaterialPlan& m) {
  if (!(m.indirect > 0.0)) return {};
  if (m.follows) {
    return "  light from other surfaces kept: leaving it out would change " + percent_text(m.indirect) + "\n";
  }
  return "  light from other surfaces left out: changes " + percent_text(m.indirect) + "\n";
}

std::string details_of(const MaterialPlan& m, const ReportStyle& style) {
  std::string text = tinted(printable(m.name), Tint::bold, style.color);
  if (!m.plan) {
    text += ": as it is, since " + m.why_not + "\n";
    return text + interreflection_text(m) + "\n";
  }
  text += fmt::format(": {}; {}\n", effects_text(m.plan->material.components), angles_text(m.plan->domain));
  for (const PlanLine& line : m.plan->lines) {
    text += "  " + tinted(line.text(), line.simplified ? Tint::good : Tint::none, style.color) + "\n";
  }
  return text + interreflection_text(m) + "\n";
}

}  // namespace

std::string left_out_text(const MaterialPlan& plan) {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (plan.plan) {
    for (const PlanLine& line : plan.plan->lines) {
      if (line.simplified && (line.choice == "left out" || line.choice == "none")) add(line.subject);
    }
  }
  if (!plan.follows) add("interreflection");
  return text.empty() ? "nothing" : text;
}

std::string scene_plan_text(const ScenePlan& plan, const ReportStyle& style) {
  std::string text;
  for (const MaterialPlan& m : plan.materials) text += details_of(m, style);
  TextTable table({{"material", Align::left},
                   {"effects", Align::left},
                   {"left out", Align::left},
                   {"simpler", Align::left},
                   {"error", Align::right},
                   {"ns", Align::right},
                   {"all, exact", Align::right},
                   {"faster", Align::right}});
  for (const MaterialPlan& m : plan.materials) {
    if (!m.plan) continue;
    const Plan& p = *m.plan;
    table.add_row({printable(m.name), effects_text(p.material.components), left_out_text(m), simpler_terms_text(p),
                   percent_text(p.error.worst_l1), fmt::format("{:.2g}", m.ns), fmt::format("{:.2g}", m.ns_exact),
                   fmt::format("{:.2g} x", m.ns_exact / m.ns)});
  }
  if (!table.empty()) text += table.str(0, style.color) + "\n";
  text += bounces_text(plan.bounces) + "\n";
  text += fmt::format(
      "predicted error of the image {} (relative RMS over lit pixels, measured on small pictures), asked for {}\n"
      "planned in {}\n",
      percent_text(plan.predicted_error), percent_text(plan.tolerance), duration_text(plan.seconds));
  return text;
}

std::string scene_plan_json(const ScenePlan& plan) {
  const BouncePlan& b = plan.bounces;
  Json out{{"tolerance", plan.tolerance},
           {"reflections", {{"given", b.given}, {"planned", b.planned}, {"change", b.change}, {"saves", b.saves}}},
           {"predicted_error", plan.predicted_error},
           {"seconds", plan.seconds},
           {"materials", Json::array()}};
  for (std::size_t i = 0; i < plan.materials.size(); ++i) {
    const MaterialPlan& m = plan.materials[i];
    Json entry{{"name", m.name}, {"planned", nullptr}};
    if (m.plan) {
      entry["ns_per_evaluation"] = m.ns;
      entry["ns_exact"] = m.ns_exact;
      entry["planned"] = Json::parse(plan_json(*m.plan));
    } else {
      entry["why_not"] = m.why_not;
    }
    entry["left_out"] = left_out_text(m);
    entry["follows"] = m.follows;
    entry["indirect"] = m.indirect;
    entry["material"] = Json::parse(to_json(plan.planned[i].material));
    out["materials"].push_back(std::move(entry));
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
