#include <nlohmann/json.hpp>

#include "report/fit_rows.h"
#include "report/material_json.h"
#include "report/tradeoff_report.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

void add_term(Json& out, const TermFigures& t) {
  out["mean_absolute_error"] = t.error.mean_absolute;
  out["mean_relative_error"] = t.error.mean_relative;
  out["max_absolute_error"] = t.error.max_absolute;
  out["term_ns"] = t.time.median_ns;
  out["term_ns_min"] = t.time.min_ns;
  out["term_ns_max"] = t.time.max_ns;
  out["gain"] = t.gain;
}

void add_fit(Json& out, const FitFigures& f) {
  out["fit_ms"] = f.ms;
  out["fit_loss"] = f.loss;
  out["slope"] = f.slope;
  out["slope_error"] = f.slope_error;
  out["converged"] = f.converged;
}

Json row_json(const TradeoffRow& r, InstructionSet instructions) {
  Json out{{"name", r.name},
           {"group", name_of(r.group)},
           {"terms", r.terms ? terms_json(*r.terms) : Json(nullptr)},
           {"effects", effect_names(r.effects)},
           {"material", r.material},
           {"model", r.model},
           {"arithmetic", r.arithmetic},
           {"instruction_set", name_of(instructions)},
           {"tolerance", r.tolerance},
           {"shadowing_shortcut", r.shadowing_shortcut},
           {"ns_per_evaluation", r.time.median_ns},
           {"ns_min", r.time.min_ns},
           {"ns_max", r.time.max_ns},
           {"ns_per_direction", r.ns_per_direction ? Json(*r.ns_per_direction) : Json(nullptr)},
           {"time_ratio", r.time.ratio},
           {"ratio_to", r.ratio_to},
           {"reference", r.reference},
           {"l1_error", r.error.l1},
           {"rms_relative_error", r.error.rms_relative},
           {"max_relative_error", r.error.max_relative},
           {"pareto", r.pareto}};
  if (!r.term) {
    out["worst_l1_error"] = r.error.worst_l1;
    out["worst_theta_i_deg"] = r.error.worst_theta_i_deg;
  }
  if (r.term) add_term(out, *r.term);
  if (r.fit) add_fit(out, *r.fit);
  if (!r.note.empty()) out["note"] = r.note;
  return out;
}

}  // namespace

std::string tradeoff_json(const Tradeoff& t) {
  Json out{{"machine", t.machine},    {"instruction_set", name_of(t.instructions)}, {"reference", t.reference},
           {"seed", t.settings.seed}, {"rounds", t.settings.timing.rounds},         {"pairs", t.settings.pairs},
           {"rows", Json::array()}};
  for (const TradeoffRow& row : t.rows) out["rows"].push_back(row_json(row, t.instructions));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
