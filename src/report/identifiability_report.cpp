#include "report/identifiability_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/text_table.h"

namespace goniofit {

namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string body(const std::string& text, Tint tint, bool color) {
  return "  " + tinted(wrapped(text, 2), tint, color) + '\n';
}

std::string size_text(const Identifiability& i) {
  if (!std::isfinite(i.condition)) return "some direction of the parameters changes no reading";
  return fmt::format("the worst-known direction is known to {:.2g} of the parameters' own sizes, the best to {:.2g}",
                     1.0 / i.singular_values.back(), 1.0 / i.singular_values.front());
}

}  // namespace

std::string identifiability_block(const FitResult& result, bool color) {
  const Identifiability& i = result.identifiability;
  if (i.singular_values.empty()) return {};
  std::string out;
  if (i.open.empty()) {
    out += body("every parameter that is free; " + size_text(i), Tint::none, color);
  } else {
    std::string open;
    for (const OpenDirection& direction : i.open) {
      if (!open.empty()) open += "; ";
      open += fmt::format("{}", fmt::join(direction.keys, " with "));
    }
    out += body("not " + open + " (see the warnings); " + size_text(i), Tint::warning, color);
  }
  if (result.design && result.design->worth_saying) out += body(design_sentence(*result.design), Tint::none, color);
  return out;
}

Json identifiability_json(const Identifiability& i) {
  Json out;
  out["singular_values"] = i.singular_values;
  out["condition"] = finite_or_null(i.condition);
  out["open"] = Json::array();
  for (const OpenDirection& direction : i.open) {
    Json one{{"parameters", direction.keys}, {"null", direction.null}, {"uncertainty", finite_or_null(direction.u)}};
    one["known"] = nullptr;
    if (const auto& known = direction.known) {
      one["known"] = {{"combination", known->text}, {"value", known->value}, {"standard_uncertainty", known->u}};
    }
    out["open"].push_back(std::move(one));
  }
  return out;
}

Json design_json(const std::optional<MeasurementDesign>& design) {
  if (!design) return nullptr;
  const auto options = [](const std::vector<DesignOption>& all) {
    Json list = Json::array();
    for (const DesignOption& o : all) {
      list.push_back({{"theta_i_deg", o.theta_i_deg}, {"standard_uncertainty", finite_or_null(o.u)}});
    }
    return list;
  };
  Json out;
  out["parameter"] = design->name;
  out["channel"] = design->channel.empty() ? Json(nullptr) : Json(design->channel);
  out["value"] = design->value ? Json(*design->value) : Json(nullptr);
  out["standard_uncertainty"] = finite_or_null(design->u);
  out["best"] = options(design->options);
  out["candidates"] = options(design->singles);
  out["worth_saying"] = design->worth_saying;
  return out;
}

}  // namespace goniofit
