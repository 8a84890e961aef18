#include "cli/selection_study_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/fit_rows.h"
#include "report/text_table.h"

namespace goniofit::cli {

using Json = nlohmann::ordered_json;

std::string selection_study_text(const SelectionStudy& study, const ReportStyle& style) {
  std::string out = tinted("choice of the components", Tint::bold, style.color) + '\n';
  out += fmt::format("  scans            {}, of {} sets of effects, each effect at five of its uncertainties or more\n",
                     study.trials.size(), study.sets);
  out += fmt::format("  the true set     {} ({:.1f} %; at least 95 % are asked for)\n", study.right(),
                     100.0 * static_cast<double>(study.right()) / static_cast<double>(study.trials.size()));
  out += fmt::format("  effects left out {} (none is allowed)\n", study.left_out());
  for (const SelectionTrial& t : study.trials) {
    if (t.right()) continue;
    const std::string text = fmt::format("{} for {}: {}", fmt::join(effect_names(t.chosen), " + "),
                                         fmt::join(effect_names(t.truth), " + "), t.material);
    out += "  " + wrapped(text, 2) + '\n';
  }
  return out + "  " +
         (study.passed() ? tinted("passed", Tint::good, style.color) : tinted("FAILED", Tint::bad, style.color)) + '\n';
}

std::string selection_study_json(const SelectionStudy& study) {
  Json misses = Json::array();
  for (const SelectionTrial& t : study.trials) {
    if (t.right()) continue;
    misses.push_back({{"truth", effect_names(t.truth)},
                      {"chosen", effect_names(t.chosen)},
                      {"left_out", t.left_out()},
                      {"score_difference", t.score_difference ? Json(*t.score_difference) : Json(nullptr)},
                      {"material", t.material}});
  }
  const Json out{{"selection",
                  {{"scans", study.trials.size()},
                   {"sets", study.sets},
                   {"right", study.right()},
                   {"left_out", study.left_out()},
                   {"misses", std::move(misses)},
                   {"passed", study.passed()}}},
                 {"passed", study.passed()}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit::cli
