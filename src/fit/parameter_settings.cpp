#include "fit/parameter_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "support/error.h"

namespace goniofit {

namespace {

constexpr std::array<std::string_view, 9> parameter_names{"slope", "sigma_um", "tau_um", "k_dd", "k_udf",
                                                          "k_uds", "k_fs",     "n",      "f0"};
constexpr std::array<std::string_view, 3> shared_names{"slope", "sigma_um", "tau_um"};

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
  for (const auto& [key, setting] : settings.parameters) {
    const std::size_t dot = key.rfind('.');
    const std::string name = dot == std::string::npos ? key : key.substr(dot + 1);
    if (!contains(parameter_names, name)) {
      throw usage_error("parameter " + key +
                        ": no such parameter, expected one of slope, sigma_um, tau_um, k_dd, k_udf, k_uds, "
                        "k_fs, n, f0 or CHANNEL.name");
    }
    if (dot == std::string::npos) continue;
    const std::string channel = key.substr(0, dot);
    if (!contains(channels, channel)) {
      throw usage_error("parameter " + key + ": no such channel, the scan has " + list(channels));
    }
    if (contains(shared_names, name)) {
      throw usage_error("parameter " + key + ": " + name + " is shared by all channels, expected " + name);
    }
  }
}

}  // namespace goniofit
