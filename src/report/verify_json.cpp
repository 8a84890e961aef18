#include <cmath>

#include <nlohmann/json.hpp>

#include "report/verify_report.h"

namespace goniofit {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json value_or_null(const std::optional<double>& value) { return value ? finite_or_null(*value) : Json(nullptr); }
Json limits_json(Interval limits) { return {limits.lower, limits.upper}; }
Json range_json(const std::optional<std::pair<double, double>>& range) {
  return range ? Json{range->first, range->second} : Json(nullptr);
}
Json fraction_json(Proportion p) { return p.of > 0 ? Json(p.fraction()) : Json(nullptr); }
Json proportion_limits(Proportion p) { return p.of > 0 ? limits_json(exact_limits(p)) : Json(nullptr); }

Json recovery_json(const Recovery& r) {
  return {{"parameter", r.parameter},
          {"truth", finite_or_null(r.truth)},
          {"truth_on_bound", r.truth_on_bound},
          {"determined", r.determined},
          {"mean", finite_or_null(r.mean)},
          {"bias", finite_or_null(r.bias)},
          {"bias_standard_error", r.determined > 1 ? finite_or_null(r.bias_error) : Json(nullptr)},
          {"spread", finite_or_null(r.spread)},
          {"mean_standard_uncertainty", r.stated_u > 0 ? finite_or_null(r.mean_u) : Json(nullptr)},
          {"coverage_68", fraction_json(r.coverage_68)},
          {"coverage_68_limits", proportion_limits(r.coverage_68)},
          {"stated_68", r.coverage_68.of},
          {"coverage_95", fraction_json(r.coverage_95)},
          {"coverage_95_limits", proportion_limits(r.coverage_95)},
          {"stated", r.coverage_95.of}};
}

Json check_json(const BoundCheck& check) {
  return {{"parameter", check.parameter.empty() ? Json(nullptr) : Json(check.parameter)},
          {"bound", name_of(check.bound)},
          {"measured", finite_or_null(check.measured)},
          {"allowed", limits_json(check.allowed)},
          {"p", value_or_null(check.p)},
          {"adjusted_p", value_or_null(check.adjusted_p)},
          {"missed", check.missed}};
}

Json bounds_json(const VerifySettings& s) {
  return {{"slope_bias", s.slope_bias},
          {"bias", value_or_null(s.bias)},
          {"coverage_68", range_json(s.coverage_68)},
          {"coverage_95", range_json(s.coverage_95)},
          {"failure_rate", s.failure_rate}};
}

Json report_json(const VerifyReport& report) {
  const VerifySettings& s = report.settings;
  Json out{{"name", report.name},
           {"sampling", s.sampling == Sampling::hemisphere ? "hemisphere" : "incidence-plane"},
           {"noise", {{"relative", s.noise.relative}, {"additive", s.noise.additive}, {"known", s.known_noise}}},
           {"bounds", bounds_json(s)},
           {"seed", report.seed},
           {"trials", report.trials},
           {"failures", report.failures},
           {"failure_rate_limit", exact_limits(report.failure_rate(), 0.90).upper}};
  out["parameters"] = Json::array();
  for (const Recovery& r : report.parameters) out["parameters"].push_back(recovery_json(r));
  out["undetermined"] = report.undetermined;
  out["checks"] = Json::array();
  for (const BoundCheck& check : report.checks) out["checks"].push_back(check_json(check));
  out["missed"] = report.missed;
  out["passed"] = report.missed.empty();
  return out;
}

Json random_json(const RandomRecoveryReport& report) {
  return {{"materials", report.materials},
          {"wrong_minima", report.wrong_minima},
          {"worst_ratio", finite_or_null(report.worst_ratio)},
          {"polish_starts", report.polish_starts},
          {"polish_failures", report.polish_failures},
          {"failures", report.failures},
          {"passed", report.wrong_minima == 0}};
}

}  // namespace

std::string verify_json(const VerifyRunReport& run) {
  Json out{{"level", run.level}, {"tests", run.tests()}, {"recipes", Json::array()}};
  for (const VerifyReport& report : run.recipes) out["recipes"].push_back(report_json(report));
  out["random"] = run.random == nullptr ? Json(nullptr) : random_json(*run.random);
  out["passed"] = run.passed();
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace goniofit
