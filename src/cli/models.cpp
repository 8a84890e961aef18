// goniofit models: what there is to choose from.

#include <cmath>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "brdf/material.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/model_catalogue.h"
#include "report/fit_rows.h"
#include "report/number_text.h"
#include "report/text_table.h"

namespace goniofit::cli {
namespace {

using Json = nlohmann::ordered_json;
using Align = TextTable::Align;

constexpr const char* model_meaning =
    "Li & Torrance 2005: one reflectance formula, four exchangeable terms, six effects";

std::string bounds_text(const ParameterEntry& p) {
  return number_text(p.min) + " … " + (std::isinf(p.max) ? "∞" : number_text(p.max));
}

std::string heading(const std::string& text, bool color) { return '\n' + tinted(text, Tint::bold, color) + '\n'; }

std::string peers_text(bool color) {
  TextTable table({{"model", Align::left},
                   {"parameter", Align::left},
                   {"scope", Align::left},
                   {"unit", Align::left},
                   {"bounds", Align::left},
                   {"meaning", Align::left}});
  for (const PeerEntry& peer : peer_entries()) {
    const std::string optics = peer.reads_fresnel ? "; reads n and kappa, or f0" : "";
    table.add_row({peer.name, "", "", "", "", peer.meaning + optics + " (" + peer.paper + ")"});
    for (const ParameterEntry& p : peer.parameters) {
      table.add_row({"", p.name, p.scope, p.unit.empty() ? "–" : unit_text(p.unit), bounds_text(p)});
    }
  }
  return heading("Peers (--model)", color) + table.str(2, color);
}

std::string catalogue_text(bool color) {
  std::string out = tinted(std::string(surface_model), Tint::bold, color) + "  " + model_meaning + '\n';
  TextTable effects(
      {{"effect", Align::left}, {"coefficient", Align::left}, {"value", Align::left}, {"meaning", Align::left}});
  for (const EffectEntry& e : effect_catalogue()) effects.add_row({e.name, e.coefficient, e.formula, e.meaning});
  out += heading("Effects", color) + effects.str(2, color);
  TextTable tiers({{"term", Align::left}, {"tier", Align::left}, {"", Align::left}, {"meaning", Align::left}});
  for (const TermEntry& term : term_catalogue()) {
    for (const TierEntry& tier : term.tiers) {
      const bool first = &tier == &term.tiers.front();
      tiers.add_row(
          {first ? term.name : "", tier.name, Cell(tier.is_default ? "default" : "", Tint::faint), tier.meaning});
    }
  }
  out += heading("Terms", color) + tiers.str(2, color);
  TextTable parameters({{"parameter", Align::left},
                        {"scope", Align::left},
                        {"unit", Align::left},
                        {"bounds", Align::left},
                        {"meaning", Align::left}});
  for (const ParameterEntry& p : parameter_catalogue()) {
    parameters.add_row({p.name, p.scope, p.unit.empty() ? "–" : unit_text(p.unit), bounds_text(p), p.meaning});
  }
  out += heading("Parameters", color) + parameters.str(2, color);
  out += "  terms li-torrance are the defaults; he-torrance: exact, smith, he, he-torrance\n";
  return out + peers_text(color);
}

Json parameter_json(const ParameterEntry& p) {
  return {{"name", p.name},
          {"scope", p.scope},
          {"unit", p.unit},
          {"min", p.min},
          {"max", std::isinf(p.max) ? Json(nullptr) : Json(p.max)},
          {"meaning", p.meaning}};
}

std::string catalogue_json() {
  Json model{{"name", surface_model}, {"meaning", model_meaning}};
  for (const EffectEntry& e : effect_catalogue()) {
    model["effects"].push_back(
        {{"name", e.name}, {"coefficient", e.coefficient}, {"formula", e.formula}, {"meaning", e.meaning}});
  }
  for (const TermEntry& term : term_catalogue()) {
    Json tiers = Json::array();
    for (const TierEntry& tier : term.tiers) {
      tiers.push_back({{"name", tier.name}, {"default", tier.is_default}, {"meaning", tier.meaning}});
    }
    model["terms"][term.name] = std::move(tiers);
  }
  for (const ParameterEntry& p : parameter_catalogue()) model["parameters"].push_back(parameter_json(p));
  Json models = Json::array({std::move(model)});
  for (const PeerEntry& peer : peer_entries()) {
    Json entry{{"name", peer.name},
               {"meaning", peer.meaning},
               {"paper", peer.paper},
               {"reads_fresnel", peer.reads_fresnel},
               {"parameters", Json::array()}};
    for (const ParameterEntry& p : peer.parameters) {
      Json parameter = parameter_json(p);
      parameter.erase("meaning");
      entry["parameters"].push_back(std::move(parameter));
    }
    models.push_back(std::move(entry));
  }
  return Json{{"models", std::move(models)}}.dump(2) + '\n';
}

}  // namespace

void add_models(CLI::App& program, int& status) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand("models", "The effects, the tiers of their terms and the parameters");
  command->add_flag("--json", *json, "the same as JSON");
  command->footer("Example:\n  goniofit models");
  command->callback([json, &status] {
    to_stdout(*json ? catalogue_json() : catalogue_text(stdout_style().color));
    status = 0;
  });
}

}  // namespace goniofit::cli
