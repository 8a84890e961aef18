#include "report/uncertainty_report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "fit/correlation.h"
#include "report/number_text.h"

namespace goniofit {
namespace {

constexpr double strong = 0.9;
constexpr std::size_t most_pairs = 8;

// With the decimals that the interval's width supports.
std::string limit_text(double limit, double width) {
  return width > 0.0 ? value_text(limit, width).value : number_text(limit);
}

std::string source_sentence(const FitResult& result) {
  switch (result.uncertainty_from) {
    case UncertaintySource::readings:
      return "standard uncertainties (k = 1) are propagated from those of the readings, unscaled";
    case UncertaintySource::angles:
      return "standard uncertainties (k = 1) are from the differences between incidence angles (CR3), intervals from a "
             "wild bootstrap over them";
    case UncertaintySource::hc3:
      return "standard uncertainties (k = 1) are from the residuals (HC3)";
    case UncertaintySource::residuals:
      break;
  }
  return "standard uncertainties (k = 1) are from the noise that the residuals show";
}

std::string reach_sentence(const FitResult& result) {
  double least = INFINITY;
  double most = 0.0;
  for (const FittedParameter& p : result.parameters) {
    if (!p.coverage_factor) continue;
    least = std::min(least, *p.coverage_factor);
    most = std::max(most, *p.coverage_factor);
  }
  if (most == 0.0) return {};
  const std::string k =
      most - least < 0.005 ? fmt::format("{:.2f}", most) : fmt::format("{:.2f} to {:.2f}", least, most);
  return "95 % intervals reach k = " + k + " standard uncertainties, but for those that a bound cuts off";
}

std::string chi_square_sentence(const FitResult& result) {
  if (!result.reduced_chi_square) return {};
  return fmt::format(
      "by the readings' uncertainties χ²ν = {:.3g}: scaled by its root, those from the readings are {:.3g} "
      "times as large",
      *result.reduced_chi_square, std::sqrt(*result.reduced_chi_square));
}

// Relative, the largest of the channels.
std::string scale_sentence(const FitResult& result) {
  std::map<std::string, double> largest;
  for (const FittedParameter& p : result.parameters) {
    if (!p.u_scale || !p.value || *p.value == 0.0) continue;
    const double part = std::fabs(*p.u_scale / *p.value);
    if (part > 1e-6) largest[p.name] = std::max(largest[p.name], part);
  }
  if (largest.empty()) return {};
  std::string text = "of which ";
  for (const auto& [name, part] : largest) {
    text += (text.size() > 9 ? ", " : "") + percent_text(part) + " of " + name;
  }
  return text + (largest.size() == 1 ? " is" : " are") + " the instrument's scale, common to all readings";
}

std::string correlation_sentence(const Correlation& correlation) {
  const std::vector<CorrelatedPair> pairs = strong_pairs(correlation, strong);
  if (pairs.empty()) return {};
  std::string text = "strongly correlated: ";
  for (std::size_t i = 0; i < std::min(pairs.size(), most_pairs); ++i) {
    text += fmt::format("{}{} and {} ({:+.2f})", i > 0 ? ", " : "", correlation.names[pairs[i].first],
                        correlation.names[pairs[i].second], pairs[i].correlation);
  }
  if (pairs.size() > most_pairs) text += fmt::format(" and {} more pairs", pairs.size() - most_pairs);
  return text;
}

}  // namespace

std::string interval_text(const FittedParameter& p) {
  if (!p.value || !p.interval_95) return {};
  const double width = (p.interval_95->upper - p.interval_95->lower) / 4.0;
  if (p.at_lower && p.interval_95->lower <= p.lower) return "< " + limit_text(p.interval_95->upper, width);
  if (p.at_upper && p.interval_95->upper >= p.upper) return "> " + limit_text(p.interval_95->lower, width);
  return limit_text(p.interval_95->lower, width) + " … " + limit_text(p.interval_95->upper, width);
}

std::vector<std::string> uncertainty_sentences(const FitResult& result) {
  std::vector<std::string> sentences{source_sentence(result), reach_sentence(result), chi_square_sentence(result),
                                     scale_sentence(result), correlation_sentence(result.correlation)};
  std::erase(sentences, std::string());
  return sentences;
}

nlohmann::ordered_json uncertainty_json(const FitResult& result) {
  nlohmann::ordered_json out;
  out["from"] = name_of(result.uncertainty_from);
  out["scale_u"] = result.scale_u;
  out["reduced_chi_square"] =
      result.reduced_chi_square ? nlohmann::ordered_json(*result.reduced_chi_square) : nlohmann::ordered_json(nullptr);
  const Correlation& c = result.correlation;
  out["correlation"]["names"] = c.names;
  out["correlation"]["matrix"] = c.matrix;
  return out;
}

}  // namespace goniofit
