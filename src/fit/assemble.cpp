#include "fit/assemble.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "brdf/rough_shape.h"
#include "fit/correlation.h"
#include "fit/fit_warnings.h"
#include "fit/lobe_significance.h"
#include "fit/scan_support.h"
#include "fit/shape_rows.h"
#include "fit/uncertainty.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

std::string key_of(const FittedParameter& p) { return p.channel.empty() ? p.name : p.channel + "." + p.name; }

void forget_uncertainty(FittedParameter& p) {
  p.u = p.u_classical = p.coverage_factor = std::nullopt;
  p.interval_68 = p.interval_95 = std::nullopt;
}

void undetermine(FittedParameter& p) {
  p.value = std::nullopt;
  forget_uncertainty(p);
  p.at_lower = p.at_upper = false;
}

bool is_one_of(std::size_t index, const std::vector<std::size_t>& indices) {
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

// Grooves that are not told from none: what they change goes with the square of their facets' slope, and that is to
// stand at four of its standard uncertainties.
bool is_flat(const FittedParameter& p) {
  if (p.name != "facet_slope_deg" || p.fixed || !p.value) return false;
  return p.at_lower || (p.u && *p.value < 2.0 * 4.0 * *p.u);
}

class Assembly {
 public:
  Assembly(const Problem& problem, const Scan& scan, const Polished& best, const FitEvidence& evidence)
      : problem_(problem),
        scan_(scan),
        best_(best),
        evidence_(evidence),
        sums_(evidence.sums),
        u_(uncertainties(LinearParts(problem, best.point, evidence.l), sums_)) {}
  [[nodiscard]] FitResult result();

 private:
  void add_totals();
  void add_published_loss();
  void add_reflectances();
  void add_shape();
  void add_channel(std::size_t c);
  void add_coefficient(std::size_t c, std::size_t coefficient);
  void leave_out_undetermined();
  void record(const FittedParameter& p, bool identifiable);
  void mark_open_directions();
  void add_flags(FittedParameter& p) const;
  void summarise();

  const Problem& problem_;
  const Scan& scan_;
  const Polished& best_;
  const FitEvidence& evidence_;
  const LinearSums& sums_;
  Uncertainties u_;
  FitResult out_;
  FitSummary summary_;
};

FitResult Assembly::result() {
  Material& m = out_.material;
  m.name = scan_.name;
  m.model = problem_.model;
  m.components = problem_.components;
  m.terms = problem_.terms;
  m.forms = problem_.forms;
  m.solid_angle_sr = problem_.solid_angle_sr;
  out_.notes = problem_.notes;
  out_.warnings = problem_.warnings;
  add_totals();
  add_shape();
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) add_channel(c);
  out_.identifiability = evidence_.identifiability;
  mark_open_directions();
  if (problem_.model == surface_model) leave_out_undetermined();
  summarise();
  add_fit_warnings(out_, problem_, best_.point, evidence_);
  m.fit = summary_;
  return std::move(out_);
}

void Assembly::add_totals() {
  out_.weight = problem_.weighting;
  out_.samples = problem_.readings();
  out_.reflectances = problem_.samples() - problem_.readings();
  out_.left_out = problem_.exclusions;
  out_.objective = {.loss = problem_.loss, .value = sums_.loss};
  if (problem_.robust) {
    out_.objective.robust = problem_.robust->kernel();
    out_.objective.robust_scale = problem_.robust->scale();
  }
  add_published_loss();
  add_reflectances();
  out_.converged = best_.converged;
  out_.uncertainty_from = u_.source;
  out_.scale_u = problem_.scale_u;
  if (std::isfinite(u_.reduced_chi_square)) out_.reduced_chi_square = u_.reduced_chi_square;
  out_.correlation = correlation_of(problem_, u_);
  summary_.uncertainty_from = name_of(u_.source);
  summary_.loss = out_.loss;
  summary_.rms = out_.rms;
  summary_.samples = out_.samples;
  summary_.converged = out_.converged;
}

// Whatever was made least: the loss of the 2005 report, of the readings used.
void Assembly::add_published_loss() {
  double values = 0.0;
  for (const LinearSums::Differences& own : sums_.differences) {
    values += own.values;
    out_.loss += own.cosine_squares;
    out_.channel_rms.push_back(std::sqrt(own.squares / own.values));
  }
  out_.rms = std::sqrt(out_.loss / values);
}

void Assembly::add_reflectances() {
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    const ProblemChannel& channel = problem_.channels[c];
    for (std::size_t i = problem_.readings(); i < problem_.samples(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (channel.used.size() > 0 && channel.used[at] == 0.0) continue;
      const double fitted = channel.value[at] + evidence_.l.deviations[c][at];
      out_.fitted_reflectances.push_back({problem_.theta_i_deg[i], channel.name, pi * channel.value[at], pi * fitted});
    }
  }
}

void Assembly::record(const FittedParameter& p, bool identifiable) {
  out_.parameters.push_back(p);
  out_.parameters.back().identifiable = identifiable;
}

// What the whitened Jacobian leaves open is not identifiable, whatever its own uncertainty says; one whose partner
// stands on a bound has the uncertainty of that accident.
void Assembly::mark_open_directions() {
  for (const OpenDirection& open : out_.identifiability.open) {
    std::vector<FittedParameter*> members;
    bool on_bound = false;
    for (FittedParameter& p : out_.parameters) {
      if (std::find(open.keys.begin(), open.keys.end(), key_of(p)) == open.keys.end()) continue;
      members.push_back(&p);
      on_bound = on_bound || p.at_lower || p.at_upper;
    }
    for (FittedParameter* p : members) {
      p->identifiable = false;
      p->flags.push_back(ParameterFlag::degenerate);
      if (on_bound && members.size() > 1) forget_uncertainty(*p);
    }
  }
}

void Assembly::add_flags(FittedParameter& p) const {
  const auto add = [&p](ParameterFlag flag) {
    if (!p.has(flag)) p.flags.push_back(flag);
  };
  if (p.fixed) add(ParameterFlag::fixed);
  if (!p.fixed && (p.at_lower || p.at_upper)) add(ParameterFlag::at_bound);
  if (p.channel.empty() && !p.value && problem_.shape_index(p.name)) {
    add(evidence_.no_lobes ? ParameterFlag::insignificant : ParameterFlag::at_start);
  }
  const bool open = !p.identifiable || !p.value;
  if (open && p.name == name_of(Coefficient::k_fs) && !missing_for_fs(problem_, best_.point, evidence_.noise).empty()) {
    add(ParameterFlag::unsupported);
  }
  if (open && (p.name == name_of(Coefficient::k_uds) || p.name == name_of(Coefficient::k_udf)) &&
      !missing_for_uds(problem_).empty()) {
    add(ParameterFlag::unsupported);
  }
}

// The same in the material's own words.
void Assembly::summarise() {
  for (FittedParameter& p : out_.parameters) {
    add_flags(p);
    summary_.identifiable[key_of(p)] = p.identifiable;
    if (p.interval_95) summary_.interval_95[key_of(p)] = *p.interval_95;
    if (!p.u) continue;
    if (p.channel.empty()) {
      summary_.shared_uncertainty[p.name] = *p.u;
    } else {
      summary_.channel_uncertainty[p.channel][p.name] = *p.u;
    }
  }
}

void Assembly::add_shape() {
  Material& m = out_.material;
  for (FittedParameter& p : shape_rows(problem_, best_.point, u_)) {
    if (problem_.model == surface_model && is_flat(p)) undetermine(p);
    record(p, p.value.has_value());
    if (problem_.model == surface_model) {
      *m.surface.find(p.name) = p.value;
    } else {
      // A peer cannot be evaluated without: one that the scan leaves open stays where the search left it.
      const auto i = *problem_.shape_index(p.name);
      const ShapeParameter& s = problem_.basis->shape_parameters()[i];
      const double z = problem_.shape.at(best_.point.z.data())[static_cast<Eigen::Index>(i)];
      m.parameters[p.name] = p.value.value_or(std::clamp(s.origin + std::exp(z), s.lower, s.upper));
    }
  }
}

void Assembly::add_channel(std::size_t c) {
  const ProblemChannel& from = problem_.channels[c];
  MaterialChannel& to = out_.material.channels.emplace_back();
  to.name = from.name;
  to.wavelength_um = from.wavelength_um;
  if (problem_.free_optics == FreeOptics::f0) {
    to.f0 = best_.point.optics[c];
  } else if (from.n) {
    to.n = problem_.free_optics == FreeOptics::n ? best_.point.optics[c] : *from.n;
    to.kappa = from.kappa;
  } else {
    to.f0 = from.optics.f0;
  }
  if (problem_.free_optics != FreeOptics::none) {
    const std::string name = problem_.free_optics == FreeOptics::n ? "n" : "f0";
    const FittedParameter p =
        parameter_row(name, from.name, best_.point.optics[c], from.optics_lower, from.optics_upper, u_.optics[c]);
    // An optical parameter that no coefficient makes visible stays where the search left it: it has no effect there.
    record(p, p.value.has_value());
  }
  for (std::size_t j = 0; j < problem_.basis->coefficients().size(); ++j) {
    if (!problem_.basis->coefficients()[j].constant()) add_coefficient(c, j);
  }
}

void Assembly::add_coefficient(std::size_t c, std::size_t coefficient) {
  const auto j = static_cast<Eigen::Index>(coefficient);
  const ProblemChannel& channel = problem_.channels[c];
  const std::string& name = problem_.basis->coefficients()[coefficient].name;
  FittedParameter p = parameter_row(name, channel.name, best_.point.coefficients[c][j], channel.lower[j],
                                    channel.upper[j], u_.coefficients[c][coefficient]);
  // A lobe whose width nobody can tell is no lobe whose strength anybody can. (Grooves that nobody can tell from a flat
  // surface still have their albedo.)
  const bool lobe = is_lobe(*problem_.basis, coefficient);
  const bool width_unknown = problem_.model == surface_model && !out_.material.surface.slope && lobe;
  if (width_unknown && p.value != 0.0) undetermine(p);
  if (width_unknown) forget_uncertainty(p);  // how strong a lobe of unknown width may be is not known either
  // Light from below a metal: there is none, whatever else is left of the scan.
  const bool opaque = is_one_of(c, evidence_.opaque) && is_one_of(coefficient, subsurface_coefficients(problem_));
  if (opaque && !p.fixed) {
    undetermine(p);
    p.flags.push_back(ParameterFlag::opaque);
  }
  if (name == name_of(Coefficient::k_fs) && is_one_of(c, evidence_.no_fs)) undetermine(p);
  // An uncertainty beyond both the value and 1 says nothing of a coefficient whose scale is 1. Where all that it adds
  // to the scan is less than the residual of one reading, it is not determined; else it is so only apart from its
  // companions.
  const bool says_nothing = p.value && p.u && *p.u > std::max(1.0, *p.value);
  const double noise2 = sums_.loss / static_cast<double>(problem_.values_used());
  const double column2 = sums_.triangles[c].col(problem_.shape.free + j).squaredNorm();
  const bool unseen = says_nothing && *p.value * *p.value * column2 < noise2;
  if (unseen) undetermine(p);
  if (says_nothing) p.flags.push_back(ParameterFlag::degenerate);
  if (evidence_.no_lobes && lobe) p.flags.push_back(ParameterFlag::insignificant);
  record(p, p.value.has_value() && !says_nothing && !width_unknown);
  out_.material.channels[c].set_coefficient(name, p.value);
}

// The material must say nothing that the scan does not determine, and still be one: what vanished in the scan leaves
// the model.
void Assembly::leave_out_undetermined() {
  Material& m = out_.material;
  if (!m.surface.slope) {
    m.components.erase(Effect::coh);
  } else if (m.components.has(Effect::coh) && !m.surface.sigma_um) {
    m.components.erase(Effect::coh);
    out_.warnings.emplace_back(
        "coh vanishes in this scan, so sigma_um is not determined: the surface is too rough for its wavelengths to "
        "reflect coherently; fit it without coh");
  }
  if (m.components.has(Effect::rough) && !m.surface.facet_slope_deg) {
    m.surface.facet_slope_deg = 0.0;
    out_.warnings.emplace_back(
        "facet_slope_deg is not determined: nothing tells the grooves of rough from a flat surface, which the material "
        "has instead; udf says the same");
  }
  if (m.components.has(Effect::rough) && m.forms.rough == RoughForm::functional) {
    std::size_t cut = 0;
    for (std::size_t i = 0; i < problem_.readings(); ++i) {
      if (functional_is_cut(radians(*m.surface.facet_slope_deg), problem_.pairs[i])) ++cut;
    }
    if (cut > 0) {
      out_.warnings.push_back("rough: at " + std::to_string(cut) +
                              " readings of forward grazing the functional form is negative, which evaluation cuts at "
                              "zero and the fit does "
                              "not; take forms.rough = integral for facets this steep");
    }
  }
  if (problem_.anisotropic && m.surface.slope && !m.surface.slope_y) {
    out_.warnings.emplace_back(
        "slope_y is not determined apart from k_dd: the readings see the surface in one direction only; measure at "
        "another phi_i, or fit it as isotropic");
  }
}

}  // namespace

FitResult assemble(const Problem& problem, const Scan& scan, const Polished& best, const FitEvidence& evidence) {
  return Assembly(problem, scan, best, evidence).result();
}

}  // namespace goniofit
