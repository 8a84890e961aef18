#include <cmath>

#include <nlohmann/json.hpp>

#include "fit/loss.h"
#include "report/fit_report.h"
#include "report/fit_rows.h"
#include "report/identifiability_report.h"
#include "report/misfit_report.h"
#include "report/profile_report.h"
#include "report/uncertainty_report.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: an absent bound is null.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json value_or_null(const std::optional<double>& value) { return value ? finite_or_null(*value) : Json(nullptr); }

Json interval_or_null(const std::optional<Interval>& interval) {
  return interval ? Json{finite_or_null(interval->lower), finite_or_null(interval->upper)} : Json(nullptr);
}

Json parameter_json(const FittedParameter& p) {
  Json out;
  out["name"] = p.name;
  out["channel"] = p.channel.empty() ? Json(nullptr) : Json(p.channel);
  out["unit"] = p.unit;
  out["value"] = value_or_null(p.value);
  out["standard_uncertainty"] = value_or_null(p.u);
  out["classical_uncertainty"] = p.u ? value_or_null(p.u_classical) : Json(nullptr);
  out["unscaled_uncertainty"] = value_or_null(p.u_unscaled);
  out["chi2_scaled_uncertainty"] = value_or_null(p.u_chi2_scaled);
  out["scale_uncertainty"] = value_or_null(p.u_scale);
  out["interval_68"] = interval_or_null(p.interval_68);
  out["interval_95"] = interval_or_null(p.interval_95);
  out["coverage_factor"] = value_or_null(p.coverage_factor);
  out["min"] = finite_or_null(p.lower);
  out["max"] = finite_or_null(p.upper);
  out["state"] = state_of(p);
  out["identifiable"] = p.identifiable;
  out["flags"] = Json::array();
  for (const ParameterFlag flag : p.flags) out["flags"].push_back(name_of(flag));
  return out;
}

Json model_json(const FitResult& result) {
  const Material& material = result.material;
  Json out;
  out["name"] = material.model;
  out["solid_angle_sr"] = material.solid_angle_sr;
  if (material.model != surface_model) {
    out["terms"] = {{"fresnel", name_of(material.terms.fresnel)}};
    return out;
  }
  out["components"] = effect_names(material.components);
  out["components_auto"] = result.components_were_auto;
  out["anisotropic"] = material.surface.anisotropic();
  out["terms"] = {{"fresnel", name_of(material.terms.fresnel)},
                  {"shadowing", name_of(material.terms.shadowing)},
                  {"effective_roughness", name_of(material.terms.effective_roughness)},
                  {"distribution", name_of(material.terms.distribution)}};
  out["forms"] = {{"fs", name_of(material.forms.fs)},
                  {"rough", name_of(material.forms.rough)},
                  {"anisotropy", name_of(material.forms.anisotropy)}};
  return out;
}

Json channels_json(const FitResult& result) {
  Json out = Json::array();
  for (std::size_t c = 0; c < result.material.channels.size(); ++c) {
    const MaterialChannel& channel = result.material.channels[c];
    Json one;
    one["name"] = channel.name;
    one["wavelength_um"] = value_or_null(channel.wavelength_um);
    one["n"] = value_or_null(channel.n);
    one["kappa"] = value_or_null(channel.kappa);
    one["f0"] = value_or_null(channel.f0);
    one["rms"] = c < result.channel_rms.size() ? finite_or_null(result.channel_rms[c]) : Json(nullptr);
    out.push_back(std::move(one));
  }
  return out;
}

Json selection_json(const std::optional<Selection>& selection) {
  if (!selection) return nullptr;
  Json out;
  out["reason"] = selection->reason;
  out["noise"] = nullptr;
  if (selection->noise) {
    out["noise"] = {{"relative", selection->noise->relative}, {"additive", selection->noise->additive}};
  }
  out["stated_uncertainties"] = !selection->noise;
  out["u_scale"] = selection->u_scale;
  out["channels"] = selection->channels;
  out["groups"] = selection->groups;
  out["sets"] = Json::array();
  for (const SelectionRow& row : selection->rows) {
    out["sets"].push_back({{"components", effect_names(row.components)},
                           {"free_parameters", row.free_parameters},
                           {"loss", finite_or_null(row.loss)},
                           {"chi2", finite_or_null(row.chi2)},
                           {"aicc", finite_or_null(row.aicc)},
                           {"bic", finite_or_null(row.bic)},
                           {"aicc_weight", finite_or_null(row.aicc_weight)},
                           {"bic_weight", finite_or_null(row.bic_weight)},
                           {"cross_validated", value_or_null(row.cross_validated)},
                           {"difference", value_or_null(row.difference)},
                           {"difference_error", value_or_null(row.difference_error)},
                           {"chosen", row.chosen}});
  }
  out["not_tried"] = Json::array();
  for (const EffectSet set : selection->not_fitted) out["not_tried"].push_back(effect_names(set));
  return out;
}

Json reflectance_json(const FitResult& result) {
  Json out = Json::array();
  for (const HemisphericalReflectance& at : result.reflectance) {
    Json row;
    row["theta_i_deg"] = at.theta_i_deg;
    for (const double value : at.by_channel) row["by_channel"].push_back(finite_or_null(value));
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace

std::string fit_report_json(const FitResult& result, const Scan& scan) {
  Json out;
  out["name"] = result.material.name;
  out["scan"] = {{"source", scan.source},
                 {"geometry", geometry_name(scan.geometry)},
                 {"directions", scan.size()},
                 {"channels", scan.channels.size()}};
  out["model"] = model_json(result);
  out["parameters"] = Json::array();
  for (const FittedParameter& p : result.parameters) out["parameters"].push_back(parameter_json(p));
  out["uncertainty"] = uncertainty_json(result);
  out["channels"] = channels_json(result);
  out["converged"] = result.converged;
  out["loss"] = finite_or_null(result.loss);
  out["rms"] = finite_or_null(result.rms);
  out["objective"] = {
      {"loss", name_of(result.objective.loss)},
      {"weight", name_of(result.weight)},
      {"robust", name_of(result.objective.robust)},
      {"robust_scale",
       result.objective.robust == RobustKernel::none ? Json(nullptr) : finite_or_null(result.objective.robust_scale)},
      {"value", finite_or_null(result.objective.value)}};
  out["samples"] = result.samples;
  out["reflectance_readings"] = Json::array();
  for (const FittedReflectance& r : result.fitted_reflectances) {
    out["reflectance_readings"].push_back({{"theta_i_deg", r.theta_i_deg},
                                           {"channel", r.channel},
                                           {"measured", finite_or_null(r.measured)},
                                           {"fitted", finite_or_null(r.fitted)}});
  }
  out["left_out"] = {{"theta_90", result.left_out.at_90},
                     {"max_theta", result.left_out.beyond_max_theta},
                     {"retro_cone", result.left_out.retro_cone},
                     {"saturated_values", result.left_out.saturated_values},
                     {"clamped_values", result.left_out.clamped_values}};
  out["negative_values"] = result.left_out.negative_values;
  out["search"] = {{"evaluations", result.search_evaluations},
                   {"polish_starts", result.polish_starts},
                   {"polish_iterations", result.polish_iterations},
                   {"seconds", result.seconds}};
  out["diagnostics"] = result.diagnostics ? misfit_json(*result.diagnostics, scan) : Json(nullptr);
  if (!result.profiles.empty()) out["profiles"] = profiles_json(result.profiles);
  out["identifiability"] = identifiability_json(result.identifiability);
  out["design"] = design_json(result.design);
  out["selection"] = selection_json(result.selection);
  out["reflectance"] = reflectance_json(result);
  out["notes"] = result.notes;
  out["warnings"] = result.warnings;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
