#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "report/number_text.h"
#include "report/text_table.h"
#include "report/tradeoff_report.h"

namespace goniofit {
namespace {

using Rows = std::vector<const TradeoffRow*>;
using Align = TextTable::Align;

std::string ns_text(double ns) {
  return ns < 10.0 ? fmt::format("{:.2f}", ns) : ns < 100.0 ? fmt::format("{:.1f}", ns) : fmt::format("{:.0f}", ns);
}

// Percent from 0.01 % up, below that a power of ten, far above a factor: errors span many decades.
std::string error_text(double e) {
  if (!std::isfinite(e)) return "-";
  if (e == 0.0) return "0";
  if (e < 1e-4) return fmt::format("{:.0e}", e);
  if (e >= 100.0) return fmt::format("{:.2g} x", e);
  if (e >= 1.0) return fmt::format("{:.0f} %", 100.0 * e);
  return fmt::format("{:.3g} %", 100.0 * e);
}

std::string spread_text(const Timing& t) { return ns_text(t.min_ns) + " - " + ns_text(t.max_ns); }

std::string slope_text(const std::optional<FitFigures>& f) {
  return f ? fmt::format("{:.5f}", f->slope) : std::string();
}

std::vector<TextTable::Column> columns_for(TradeoffGroup group, const std::string& ratio_to) {
  std::vector<TextTable::Column> columns{{group == TradeoffGroup::effects ? "effects" : "candidate"},
                                         {""},
                                         {"ns", Align::right},
                                         {"least - most", Align::right},
                                         {"x " + ratio_to, Align::right},
                                         {"ns, all channels", Align::right},
                                         {"L1 error", Align::right},
                                         {"RMS relative", Align::right},
                                         {"largest", Align::right},
                                         {"mean absolute", Align::right},
                                         {"term ns", Align::right},
                                         {"gain", Align::right},
                                         {"fit ms", Align::right},
                                         {"loss", Align::right},
                                         {"slope", Align::right},
                                         {"off by", Align::right}};
  return columns;
}

std::vector<Cell> cells_of(const TradeoffRow& r) {
  const Tint tint = r.pareto ? Tint::good : Tint::none;
  std::vector<Cell> cells{{printable(r.name), tint},
                          {r.pareto ? "*" : "", tint},
                          {ns_text(r.time.median_ns), tint},
                          {spread_text(r.time), Tint::faint},
                          {fmt::format("{:.2f}", r.time.ratio)},
                          {r.ns_per_direction ? ns_text(*r.ns_per_direction) : ""},
                          {error_text(r.error.l1), tint},
                          {error_text(r.error.rms_relative)},
                          {error_text(r.error.max_relative)}};
  cells.emplace_back(r.term ? error_text(r.term->error.mean_absolute) : "");
  cells.emplace_back(r.term ? ns_text(r.term->time.median_ns) : "");
  cells.emplace_back(r.term ? fmt::format("{:.2f}", r.term->gain) : "");
  cells.emplace_back(r.fit ? ns_text(r.fit->ms) : "");
  cells.emplace_back(r.fit ? fmt::format("{:.3g}", r.fit->loss) : "");
  cells.emplace_back(slope_text(r.fit));
  cells.emplace_back(r.fit ? error_text(r.fit->slope_error) : "");
  return cells;
}

// Each once.
std::string notes_of(const Rows& rows) {
  std::set<std::string> notes;
  for (const TradeoffRow* row : rows) {
    if (!row->note.empty()) notes.insert(row->note);
  }
  std::string out;
  for (const std::string& note : notes) out += "  " + printable(note) + "\n";
  return out;
}

std::string table_of(Rows rows, const ReportStyle& style) {
  const TradeoffRow& any = *rows.front();
  std::stable_sort(rows.begin(), rows.end(),
                   [](const TradeoffRow* a, const TradeoffRow* b) { return a->time.median_ns < b->time.median_ns; });
  TextTable table(columns_for(any.group, any.ratio_to));
  for (const TradeoffRow* row : rows) table.add_row(cells_of(*row));
  const std::string title = fmt::format("{}: {}", name_of(any.group), printable(any.material));
  return tinted(title, Tint::bold, style.color) + "   errors against " + printable(any.reference) + "\n" +
         table.str(2, style.color) + notes_of(rows) + "\n";
}

}  // namespace

std::string tradeoff_text(const Tradeoff& t, const ReportStyle& style) {
  std::string out = fmt::format(
      "{}, {}, one thread; medians of {} rounds, {} pairs of directions at once, one channel an evaluation\n"
      "reference: {}; * nothing measured is both faster and nearer to it (by L1)\n\n",
      t.machine, name_of(t.instructions), t.settings.timing.rounds, t.settings.pairs, t.reference);
  for (std::size_t i = 0; i < t.rows.size();) {
    Rows rows;
    const TradeoffRow& first = t.rows[i];
    for (; i < t.rows.size() && t.rows[i].group == first.group && t.rows[i].material == first.material; ++i) {
      rows.push_back(&t.rows[i]);
    }
    out += table_of(std::move(rows), style);
  }
  return out;
}

}  // namespace goniofit
