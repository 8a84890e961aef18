#include "report/fit_rows.h"

#include <algorithm>

namespace goniofit {

std::string geometry_name(ScanGeometry geometry) {
  return geometry == ScanGeometry::hemispherical ? "hemispherical" : "incidence plane";
}

std::vector<std::string> effect_names(EffectSet effects) {
  std::vector<std::string> names;
  for (const Effect effect : all_effects) {
    if (effects.has(effect)) names.emplace_back(name_of(effect));
  }
  return names;
}

std::string effects_text(EffectSet effects, const std::string& separator) {
  std::string text;
  for (const std::string& name : effect_names(effects)) text += (text.empty() ? "" : separator) + name;
  return text;
}

std::string unit_text(const std::string& unit) { return unit == "um" ? "µm" : unit == "deg" ? "°" : unit; }

std::string state_of(const FittedParameter& parameter) {
  if (parameter.fixed) return "fixed";
  if (!parameter.value) return "undetermined";
  if (parameter.at_lower) return "at lower bound";
  if (parameter.at_upper) return "at upper bound";
  return parameter.derived ? "derived" : "free";
}

std::string remark_of(const FittedParameter& parameter) {
  const std::string state = state_of(parameter);
  if (state == "undetermined") return "not determined by this scan";
  return state == "free" ? std::string() : state;
}

std::string short_remark_of(const FittedParameter& parameter) {
  if (parameter.at_lower && !parameter.fixed) return "min";
  if (parameter.at_upper && !parameter.fixed) return "max";
  const std::string state = state_of(parameter);
  return state == "free" ? std::string() : state;
}

const FittedParameter* find_parameter(const FitResult& result, const std::string& channel, const std::string& name) {
  const auto found = std::find_if(result.parameters.begin(), result.parameters.end(),
                                  [&](const FittedParameter& p) { return p.channel == channel && p.name == name; });
  return found == result.parameters.end() ? nullptr : &*found;
}

std::vector<std::string> channel_parameter_names(const FitResult& result) {
  std::vector<std::string> names;
  for (const FittedParameter& p : result.parameters) {
    if (!p.channel.empty() && std::find(names.begin(), names.end(), p.name) == names.end()) names.push_back(p.name);
  }
  return names;
}

std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t kept = std::min(count, std::max<std::size_t>(most, 2));
  for (std::size_t i = 0; i < kept; ++i) {
    chosen.push_back(kept == 1 ? 0 : (i * (count - 1) + (kept - 1) / 2) / (kept - 1));
  }
  return chosen;
}

}  // namespace goniofit
