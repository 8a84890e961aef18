#include "fit/parameter_settings.h"

#include <algorithm>
#include <memory>
#include <sstream>
#include <string_view>

#include "basis/basis.h"
#include "peers/peers.h"
#include "support/error.h"

namespace goniofit {

namespace {

// What a model's parameters are called: shared ones first, then those of a channel.
struct ModelNames {
  std::vector<std::string> shared, channel;
};

ModelNames names_of_model(const std::string& model) {
  ModelNames names;
  if (model == surface_model) {
    names.shared.assign(surface_parameter_names.begin(), surface_parameter_names.end());
    std::erase(names.shared, "tau_y_um");  // follows from slope_y
    for (const Coefficient c : all_coefficients) names.channel.emplace_back(name_of(c));
  } else if (const std::unique_ptr<const Basis> basis = make_peer(model)) {
    for (const ShapeParameter& p : basis->shape_parameters()) names.shared.push_back(p.name);
    for (const BasisCoefficient& c : basis->coefficients()) {
      if (!c.constant()) names.channel.push_back(c.name);
    }
  } else {
    throw usage_error("model " + model + ": no such model, expected one that `goniofit models` names");
  }
  names.channel.insert(names.channel.end(), {"n", "f0"});
  return names;
}

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string text_of(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

}  // namespace

ParameterSetting setting_of(const FitSettings& settings, const std::string& name, const std::string& channel) {
  if (!channel.empty()) {
    if (const auto it = settings.parameters.find(channel + "." + name); it != settings.parameters.end())
      return it->second;
  }
  const auto it = settings.parameters.find(name);
  return it == settings.parameters.end() ? ParameterSetting{} : it->second;
}

std::pair<double, double> interval_of(const ParameterSetting& setting, const std::string& name, double lower,
                                      double upper) {
  const std::string range = "[" + text_of(lower) + ", " + text_of(upper) + "]";
  const auto check = [&](double x, const char* what) {
    if (!(x >= lower && x <= upper)) {
      throw usage_error("parameter " + name + ": " + what + " " + text_of(x) + " is out of range, expected " + range);
    }
    return x;
  };
  if (setting.value) {
    const double value = check(*setting.value, "value");
    return {value, value};
  }
  const double low = setting.min ? check(*setting.min, "lower bound") : lower;
  const double high = setting.max ? check(*setting.max, "upper bound") : upper;
  if (low > high) {
    throw usage_error("parameter " + name + ": lower bound " + text_of(low) + " is above upper bound " + text_of(high));
  }
  return {low, high};
}

void check_parameter_names(const FitSettings& settings, const std::vector<std::string>& channels) {
  const ModelNames known = names_of_model(settings.model);
  for (const auto& [key, setting] : settings.parameters) {
    const std::size_t dot = key.rfind('.');
    const std::string name = dot == std::string::npos ? key : key.substr(dot + 1);
    if (!contains(known.shared, name) && !contains(known.channel, name)) {
      throw usage_error("parameter " + key + ": no such parameter, expected one of " +
                        (known.shared.empty() ? "" : list(known.shared) + ", ") + list(known.channel) +
                        " or CHANNEL.name");
    }
    if (dot == std::string::npos) continue;
    const std::string channel = key.substr(0, dot);
    if (!contains(channels, channel)) {
      throw usage_error("parameter " + key + ": no such channel, the scan has " + list(channels));
    }
    if (contains(known.shared, name)) {
      throw usage_error("parameter " + key + ": " + name + " is shared by all channels, expected " + name);
    }
  }
}

void check_range(double value, double lower, double upper, const std::string& name) {
  if (value >= lower && value <= upper) return;
  std::ostringstream text;
  text << name << ": " << value << " is out of range, expected " << lower << " to " << upper;
  throw usage_error(text.str());
}

}  // namespace goniofit
