// The tables of a verify run as a page has them.

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "report/number_text.h"
#include "report/verify_report.h"

namespace goniofit {
namespace {

// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? std::string("\\|") : std::string(1, c);
  return safe;
}

std::string noise_text(const VerifySettings& s) {
  std::string text;
  if (s.noise.relative > 0.0) text = number_text(100.0 * s.noise.relative) + " %";
  if (s.noise.additive > 0.0) text += (text.empty() ? "" : " + ") + number_text(s.noise.additive) + " sr⁻¹";
  if (text.empty()) return "none";
  return text + (s.known_noise ? ", u known" : "");
}

// "93.1 % (R.k_fs) – 96.2 % (slope)": the least and the largest of a recipe.
std::string coverage_range(const VerifyReport& report, Proportion Recovery::*coverage) {
  const Recovery* least = nullptr;
  const Recovery* most = nullptr;
  for (const Recovery& r : report.parameters) {
    if ((r.*coverage).of == 0) continue;
    if (least == nullptr || (r.*coverage).fraction() < (least->*coverage).fraction()) least = &r;
    if (most == nullptr || (r.*coverage).fraction() > (most->*coverage).fraction()) most = &r;
  }
  if (least == nullptr) return "–";
  return fmt::format("{:.1f} % ({}) – {:.1f} % ({})", 100.0 * (least->*coverage).fraction(), least->parameter,
                     100.0 * (most->*coverage).fraction(), most->parameter);
}

std::string slope_text(const VerifyReport& report) {
  for (const Recovery& r : report.parameters) {
    if (r.parameter != "slope") continue;
    const ValueText text = value_text(100.0 * r.bias / r.truth, 100.0 * r.bias_error / r.truth);
    return text.value + " ± " + text.uncertainty + " %";
  }
  return "–";
}

// The parameter that the fewest trials state a 95 % interval of.
std::string stated_text(const VerifyReport& report) {
  const auto least =
      std::min_element(report.parameters.begin(), report.parameters.end(),
                       [](const Recovery& a, const Recovery& b) { return a.coverage_95.of < b.coverage_95.of; });
  if (least == report.parameters.end()) return "–";
  if (least->coverage_95.of == report.trials) return "all";
  return fmt::format("{} ({})", least->coverage_95.of, least->parameter);
}

std::string random_text(const RandomRecoveryReport& random) {
  std::string out = fmt::format(
      "\nRandom materials: {} of {} in a wrong minimum, loss at most {:.6g} times that reached "
      "from the truth",
      random.wrong_minima, random.materials, random.worst_ratio);
  if (random.polish_starts > 0) {
    out += fmt::format("; of the polish alone, {} of {} random starts", random.polish_failures, random.polish_starts);
  }
  out += ".\n";
  for (const std::string& failure : random.failures) out += "* " + failure + '\n';
  return out;
}

std::string recipe_row(const VerifyReport& report) {
  const auto tests = std::count_if(report.checks.begin(), report.checks.end(), [](const auto& c) { return c.p; });
  return fmt::format(
      "| {} | {}, {} | {} of {} | {} | {} | {} | {} | {} of {} |\n", cell(report.name),
      report.settings.sampling == Sampling::hemisphere ? "hemisphere" : "plane", noise_text(report.settings),
      report.failures, report.trials, slope_text(report), cell(coverage_range(report, &Recovery::coverage_68)),
      cell(coverage_range(report, &Recovery::coverage_95)), stated_text(report), report.missed.size(), tests);
}

/// What was missed of one parameter, in however many channels.
struct MissedRow {
  std::string name;
  Bound bound;
  Interval allowed;
  std::vector<std::string> channels;
  double least, most;
  std::optional<double> p;  ///< the smallest; none of slope_bias
};

std::vector<MissedRow> missed_rows(const VerifyReport& report) {
  std::vector<MissedRow> rows;
  for (const BoundCheck& check : report.checks) {
    if (!check.missed) continue;
    const std::size_t dot = check.parameter.find('.');
    const bool shared = dot == std::string::npos;
    const std::string name = shared ? check.parameter : check.parameter.substr(dot + 1);
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const MissedRow& r) { return r.name == name && r.bound == check.bound; });
    if (row == rows.end()) {
      row = rows.insert(rows.end(),
                        {name, check.bound, check.allowed, {}, check.measured, check.measured, check.adjusted_p});
    }
    if (!shared) row->channels.push_back(check.parameter.substr(0, dot));
    row->least = std::min(row->least, check.measured);
    row->most = std::max(row->most, check.measured);
    if (check.adjusted_p) row->p = std::min(row->p.value_or(1.0), *check.adjusted_p);
  }
  return rows;
}

std::string channels_text(const std::vector<std::string>& channels) {
  constexpr std::size_t most = 4;
  if (channels.size() > most) return fmt::format(" of {} channels", channels.size());
  std::string text;
  for (const std::string& channel : channels) text += (text.empty() ? " of " : ", ") + channel;
  return text;
}

std::string range_text(double low, double high, Bound bound) {
  if (bound == Bound::bias) {
    return low == high ? fmt::format("{:+.2f} u", low) : fmt::format("{:+.2f} to {:+.2f} u", low, high);
  }
  const std::string percent = fmt::format("{:.1f}", 100.0 * low);
  return low == high ? percent + " %" : fmt::format("{} to {:.1f} %", percent, 100.0 * high);
}

std::string missed_text(const VerifyRunReport& run) {
  std::string out = "\n| scenario | what misses | measured | allowed | p, corrected |\n|---|---|---|---|---|\n";
  for (const VerifyReport& report : run.recipes) {
    for (const MissedRow& row : missed_rows(report)) {
      const std::string what = row.name.empty()
                                   ? std::string(name_of(row.bound))
                                   : fmt::format("{}{}: {}", row.name, channels_text(row.channels), name_of(row.bound));
      out += fmt::format(
          "| {} | {} | {} | {} | {} |\n", cell(report.name), cell(what), range_text(row.least, row.most, row.bound),
          range_text(row.allowed.lower, row.allowed.upper, row.bound), row.p ? fmt::format("{:.1g}", *row.p) : "–");
    }
  }
  return out;
}

std::string recipes_text(const VerifyRunReport& run) {
  std::string out =
      "| scenario | sampling, noise | failed | bias of the slope | in 68 % interval | in 95 % interval | stated by at "
      "least | missed |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const VerifyReport& report : run.recipes) out += recipe_row(report);
  out += fmt::format("\n{} of {} tests missed at {:g} % for all together (Holm's correction).\n", run.missed(),
                     run.tests(), 100.0 * run.level);
  return run.missed() == 0 ? out : out + missed_text(run);
}

}  // namespace

std::string verify_markdown(const VerifyRunReport& run) {
  std::string out;
  if (!run.recipes.empty()) out += recipes_text(run);
  if (run.random != nullptr) out += random_text(*run.random);
  return out;
}

}  // namespace goniofit
