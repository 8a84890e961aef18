#include "io/recipe_parameters.h"

#include <algorithm>
#include <vector>

#include "brdf/material.h"
#include "support/text.h"

namespace goniofit {

std::string Range::words(double x) { return shortest(x); }

double read_number(const TomlValue& value, const Range& range) {
  const double number = value.number(range.expected);
  value.require(range.holds(number), number, range.expected);
  return number;
}

namespace {

struct Parameter {
  std::string name;
  bool shared;
  Range range;
};

std::vector<Parameter> surface_parameters() {
  const Range slope = Range::closed(smallest_slope, largest_slope);
  const Range facet{0.0, largest_facet_slope_deg, false, true,
                    "degrees above 0 and up to " + shortest(largest_facet_slope_deg)};
  std::vector<Parameter> all{
      {"slope", true, slope},   {"sigma_um", true, Range::above(0.0)}, {"tau_um", true, Range::above(0.0)},
      {"slope_y", true, slope}, {"tail", true, Range::above(1.0)},     {"facet_slope_deg", true, facet}};
  for (const Coefficient c : all_coefficients) all.push_back({std::string(name_of(c)), false, Range::at_least(0.0)});
  return all;
}

// A peer says itself what it has, between which bounds.
std::vector<Parameter> parameters_of(const Basis* peer) {
  std::vector<Parameter> all;
  if (peer == nullptr) {
    all = surface_parameters();
  } else {
    for (const ShapeParameter& p : peer->shape_parameters()) {
      all.push_back({p.name, true, Range::closed(p.lower, p.upper)});
    }
    for (const BasisCoefficient& c : peer->coefficients()) {
      if (!c.constant()) all.push_back({c.name, false, Range::at_least(0.0)});
    }
  }
  all.push_back({"n", false, Range::above(0.0)});
  all.push_back({"f0", false, Range::closed(0.0, 1.0)});
  return all;
}

// A number fixes, {value = ...} too, {min = ..., max = ...} bound.
ParameterSetting read_setting(const TomlValue& value, const Range& range) {
  if (value.is_number()) return {read_number(value, range), std::nullopt, std::nullopt};
  if (!value.is_table()) value.fail_type("a number that fixes it, or {min = ..., max = ...}");
  value.expect_keys({"value", "min", "max"});
  ParameterSetting setting;
  if (const auto fixed = value.find("value")) setting.value = read_number(*fixed, range);
  if (const auto min = value.find("min")) setting.min = read_number(*min, range);
  if (const auto max = value.find("max")) setting.max = read_number(*max, range);
  if (setting.value && (setting.min || setting.max)) {
    value.fail("has a value and bounds, expected one or the other: value fixes, min and max bound");
  }
  if (!setting.value && !setting.min && !setting.max) value.fail("is empty, expected value, min or max");
  if (setting.min && setting.max && *setting.min >= *setting.max) {
    value.fail("has min = " + shortest(*setting.min) + " and max = " + shortest(*setting.max) +
               ", expected min below max (value fixes)");
  }
  return setting;
}

class ParameterTable {
 public:
  ParameterTable(const Basis* peer, Recipe& recipe) : known_(parameters_of(peer)), recipe_(recipe) {}

  void read(const TomlValue& table) const {
    table.for_each_member("a table", [&](const std::string& name, const TomlValue& value) {
      if (const Parameter* parameter = find(name)) {
        recipe_.settings.parameters[name] = read_setting(value, parameter->range);
      } else if (value.is_table()) {
        read_channel(value, name);
      } else {
        value.fail("is not a parameter, expected " + names(true) + ", or a channel's table");
      }
    });
  }

 private:
  [[nodiscard]] const Parameter* find(std::string_view name) const {
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const Parameter& p) { return p.name == name; });
    return found == known_.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::string names(bool with_shared) const {
    std::vector<std::string_view> all;
    for (const Parameter& p : known_) {
      if (with_shared || !p.shared) all.emplace_back(p.name);
    }
    return alternatives(all);
  }

  void read_channel(const TomlValue& table, const std::string& channel) const {
    const std::vector<std::string>& channels = recipe_.channels;
    if (!channels.empty() && std::find(channels.begin(), channels.end(), channel) == channels.end()) {
      table.fail("is neither a parameter nor a channel, expected " + names(true) + ", or a channel (" +
                 alternatives(channels) + ")");
    }
    table.for_each_member("a table", [&](const std::string& name, const TomlValue& value) {
      const Parameter* parameter = find(name);
      if (parameter == nullptr) value.fail("is not a parameter of a channel, expected " + names(false));
      if (parameter->shared) value.fail("is shared by all channels, expected it directly under [parameters]");
      recipe_.settings.parameters[channel + "." + name] = read_setting(value, parameter->range);
    });
  }

  std::vector<Parameter> known_;
  Recipe& recipe_;
};

}  // namespace

void read_parameters(const TomlValue& table, const Basis* peer, Recipe& recipe) {
  ParameterTable(peer, recipe).read(table);
}

}  // namespace goniofit
