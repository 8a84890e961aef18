#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/material_io.h"
#include "io/png_file.h"
#include "report/digest.h"
#include "report/fit_report.h"
#include "report/fit_rows.h"
#include "report/material_text.h"
#include "report/number_text.h"
#include "report/objective_text.h"
#include "report/page.h"
#include "report/page_plots.h"
#include "report/profile_report.h"
#include "report/sphere_picture.h"
#include "report/uncertainty_report.h"
#include "support/error.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

// The names that papers have for settings of the four terms; empty for a mixture.
std::string terms_name(const Terms& terms) {
  if (terms == Terms{}) return "Li–Torrance";
  for (const DistributionTier tier : {DistributionTier::he_torrance, DistributionTier::he_torrance_series}) {
    if (terms == Terms{FresnelTier::exact, ShadowingTier::smith, EffectiveRoughnessTier::he, tier})
      return "He–Torrance";
  }
  return {};
}

std::string optics_text(const MaterialChannel& c) {
  if (c.f0) return "f₀ = " + number_text(*c.f0);
  if (!c.n) return "none";
  return "n = " + number_text(*c.n) + (c.kappa.value_or(0.0) == 0.0 ? "" : ", κ = " + number_text(*c.kappa));
}

std::string optics_text(const Material& m) {
  std::set<std::string> different;
  for (const MaterialChannel& channel : m.channels) different.insert(optics_text(channel));
  if (different.size() == 1) return *different.begin();
  std::string text;
  for (const std::size_t c : evenly_chosen(m.channels.size(), 4)) {
    text += (text.empty() ? "" : "; ") + m.channels[c].name + ": " + optics_text(m.channels[c]);
  }
  return text + (m.channels.size() > 4 ? "; …" : "");
}

// What was fitted, a label and a text each.
Json subject(const FitResult& result, const Scan& scan, const PageSource& source) {
  const Material& m = result.material;
  Json out = Json::array();
  const auto say = [&out](const char* label, const std::string& text) {
    if (!text.empty()) out.push_back({label, text});
  };
  say("Scan", fmt::format("{}, {} directions × {} {}", geometry_name(scan.geometry), scan.size(), scan.channels.size(),
                          scan.channels.size() == 1 ? "channel" : "channels"));
  say("Readings", samples_text(result, scan));
  const bool peer = m.model != surface_model;
  say("Model", peer ? m.model
                    : effects_text(m.components, " + ") + (m.surface.anisotropic() ? ", anisotropic" : "") +
                          (result.components_were_auto ? " (chosen automatically)" : ""));
  const std::string named = peer ? std::string() : terms_name(m.terms);
  say("Terms", (named.empty() ? "" : named + ": ") + terms_text(m));
  say("Forms", forms_text(m));
  say("Optics", optics_text(m));
  if (m.components.has(Effect::coh)) say("Solid angle", number_text(m.solid_angle_sr) + " sr (source)");
  if (source.fitted) say("Made least", objective_text(result));
  say("RMS", fmt::format("{:.4g} sr⁻¹", result.rms));
  return out;
}

const char* words_of(FitVerdict verdict) {
  switch (verdict) {
    case FitVerdict::describes:
      return "The model describes the scan";
    case FitVerdict::systematic:
      return "In the main, with systematic residuals";
    case FitVerdict::fails:
      break;
  }
  return "The model fails to describe the scan";
}

Json verdict(const FitResult& result) {
  if (!result.diagnostics) return nullptr;
  const FitDiagnostics& d = *result.diagnostics;
  return {{"name", name_of(d.verdict)},
          {"words", words_of(d.verdict)},
          {"finding", d.findings.empty() ? std::string() : d.findings.front()}};
}

// A parameter as a person reads it.
Json parameter_text(const FittedParameter& p) {
  Json out{
      {"value", ""},           {"u", ""}, {"relative", ""}, {"interval", interval_text(p)}, {"unit", unit_text(p.unit)},
      {"remark", remark_of(p)}};
  if (!p.value) return out;
  out["value"] = number_text(*p.value);
  if (!p.u) return out;
  const ValueText text = value_text(*p.value, *p.u);
  out["value"] = text.value;
  out["u"] = text.uncertainty;
  if (*p.value != 0.0) out["relative"] = percent_text(std::fabs(*p.u / *p.value));
  return out;
}

Json sphere(const Material& material) {
  const SpherePicture picture = sphere_picture(material);
  return {{"png", "data:image/png;base64," + base64(to_png({picture.size, picture.size, picture.rgb}))},
          {"size", picture.size},
          {"alt", "A sphere of the material under one light from the upper left"},
          {"caption", fmt::format("Under one light from the upper left; {}. Exposed {:.2g} times as long as for white.",
                                  picture.bands.text, picture.exposure)}};
}

// The terminal's sentence of the source of uncertainties holds for a fit; a material may state none.
Json sentences(const FitResult& result, const PageSource& source) {
  const bool stated = source.fitted || (result.material.fit && !result.material.fit->uncertainty_from.empty());
  return stated ? Json(uncertainty_sentences(result)) : Json::array();
}

Json source_json(const PageSource& source, const FitResult& result, const Scan& scan) {
  Json out;
  out["scan"] = scan.source;
  out["inputs"] = Json::array();
  for (const PageSource::Input& input : source.inputs) {
    out["inputs"].push_back({{"role", input.role}, {"file", input.file}, {"sha256", input.sha256}});
  }
  out["command"] = source.command;
  out["versions"] = Json::array();
  for (const auto& [name, version] : source.versions) out["versions"].push_back({name, version});
  out["random"] = result.uncertainty_from == UncertaintySource::angles && source.fitted
                      ? "the bootstrap over incidence angles, by a fixed seed"
                      : "none";
  out["metadata"] = Json::array();
  for (const auto& [key, value] : scan.metadata) out["metadata"].push_back({key, value});
  return out;
}

}  // namespace

std::string page_data(const FitResult& result, const Scan& scan, const PageSource& source) {
  if (result.material.channels.size() != scan.channels.size()) {
    throw usage_error(fmt::format("the material has {} channels and the scan {}: there is nothing to report",
                                  result.material.channels.size(), scan.channels.size()));
  }
  Json out;
  out["format"] = "goniofit-report";
  out["version"] = 1;
  out["title"] = result.material.name;
  out["fitted"] = source.fitted;
  out["subject"] = subject(result, scan, source);
  out["verdict"] = verdict(result);
  out["fit"] = Json::parse(fit_report_json(result, scan));
  out["fit"]["search"].erase("seconds");  // the same arguments give the same bytes
  out["texts"] = Json::array();
  for (const FittedParameter& p : result.parameters) out["texts"].push_back(parameter_text(p));
  out["sentences"] = sentences(result, source);
  out["sphere"] = sphere(result.material);
  out["plots"] = page_plots(result, scan);
  out["material"] = Json::parse(to_json(result.material));
  out["source"] = source_json(source, result, scan);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace goniofit
