#include "report/comparison_criteria_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit {

using Align = TextTable::Align;

std::vector<const ComparedFit*> by_criteria(const Comparison& comparison) {
  std::vector<const ComparedFit*> rows;
  for (const ComparedFit& row : comparison.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [](const ComparedFit* a, const ComparedFit* b) {
    const auto key = [](const SelectionRow& r) {
      return std::tuple(!r.chosen, !r.cross_validated, r.cross_validated.value_or(0.0), r.bic);
    };
    return key(a->criteria) < key(b->criteria);
  });
  return rows;
}

std::string noise_text(const std::optional<Noise>& noise, double u_scale) {
  if (noise) {
    return fmt::format("noise estimated: {:.2g} % of the value and {:.2g} sr⁻¹", 100.0 * noise->relative,
                       noise->additive);
  }
  if (u_scale == 1.0) return "noise: the scan's own uncertainties";
  return fmt::format("noise: the scan's own uncertainties, times {:.3g} for what the residuals have more", u_scale);
}

std::string comparison_criteria_block(const Comparison& comparison, bool color) {
  if (comparison.verdict.empty()) return {};
  TextTable table({{"", Align::left},
                   {"model", Align::left},
                   {"free", Align::right},
                   {"χ²", Align::right},
                   {"ΔAICc", Align::right},
                   {"ΔBIC", Align::right},
                   {"weight", Align::right},
                   {"left-out score", Align::right},
                   {"to the best", Align::left}});
  double aicc = comparison.rows.front().criteria.aicc;
  double bic = comparison.rows.front().criteria.bic;
  for (const ComparedFit& row : comparison.rows) {
    aicc = std::min(aicc, row.criteria.aicc);
    bic = std::min(bic, row.criteria.bic);
  }
  for (const ComparedFit* const row : by_criteria(comparison)) {
    const SelectionRow& r = row->criteria;
    std::vector<Cell> cells{r.chosen ? "→" : "",
                            printable(row->model),
                            fmt::format("{}", r.free_parameters),
                            fmt::format("{:.5g}", r.chi2),
                            fmt::format("{:.4g}", r.aicc - aicc),
                            fmt::format("{:.4g}", r.bic - bic),
                            fmt::format("{:.3f}", r.bic_weight)};
    if (r.cross_validated) cells.emplace_back(fmt::format("{:.4f}", *r.cross_validated));
    if (r.difference) cells.emplace_back(fmt::format("+{:.4f} ± {:.4f}", *r.difference, *r.difference_error));
    table.add_row(std::move(cells));
  }
  const std::string how = noise_text(comparison.noise, comparison.u_scale) +
                          "; χ², AICc and BIC of fits by inverse variance; weight by the BIC; free: parameters neither "
                          "on a bound nor without effect";
  return "  What the scan says of them\n" + table.str(2, color) +
         tinted("  (" + wrapped(how, 3) + ")\n", Tint::faint, color) + "  " +
         wrapped(printable(comparison.verdict), 2) + '\n';
}

}  // namespace goniofit
