#include "fit/assemble.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "brdf/rough_shape.h"
#include "fit/correlation.h"
#include "fit/model.h"
#include "fit/shape_rows.h"
#include "fit/uncertainty.h"
#include "geometry/angles.h"

namespace goniofit {

namespace {

using ByName = std::map<std::string, std::vector<std::string>>;  // parameter, its channels

// "k_dd of every channel, k_uds of R and B".
std::string listed(const ByName& parameters, std::size_t all) {
  std::string text;
  for (const auto& [name, channels] : parameters) {
    text += (text.empty() ? "" : ", ") + name + " of ";
    if (channels.size() == all && all > 1) {
      text += "every channel";
      continue;
    }
    for (std::size_t i = 0; i < channels.size(); ++i) {
      text += (i == 0 ? "" : i + 1 == channels.size() ? " and " : ", ") + channels[i];
    }
  }
  return text;
}

class Assembly {
 public:
  Assembly(const Problem& problem, const Scan& scan, const Polished& best)
      : problem_(problem),
        scan_(scan),
        best_(best),
        l_(linearise(problem, best.point)),
        u_(uncertainties(problem, best.point, l_)) {}
  [[nodiscard]] FitResult result();

 private:
  void add_totals();
  void add_shape();
  void add_channel(std::size_t c);
  void add_coefficient(std::size_t c, std::size_t coefficient);
  [[nodiscard]] bool is_lobe(std::size_t coefficient) const;
  void add_warnings();
  void warn_of_surface();
  void warn_of_peer();
  void leave_out_undetermined();
  void record(const FittedParameter& p, bool identifiable);

  const Problem& problem_;
  const Scan& scan_;
  const Polished& best_;
  Linearisation l_;
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
  add_warnings();
  m.fit = summary_;
  return std::move(out_);
}

void Assembly::add_totals() {
  out_.weight = problem_.weighting;
  out_.samples = problem_.samples();
  out_.left_out_90 = problem_.exclusions.at_90;
  out_.left_out_max_theta = problem_.exclusions.beyond_max_theta;
  out_.negative_values = problem_.exclusions.negative_values;
  out_.loss = l_.loss;
  const auto n = static_cast<double>(problem_.samples());
  out_.rms = std::sqrt(l_.loss / (n * static_cast<double>(problem_.channels.size())));
  for (const Eigen::VectorXd& r : l_.residuals)
    out_.channel_rms.push_back(std::sqrt(r.cwiseQuotient(problem_.weight).squaredNorm() / n));
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

void Assembly::record(const FittedParameter& p, bool identifiable) {
  out_.parameters.push_back(p);
  const std::string key = p.channel.empty() ? p.name : p.channel + "." + p.name;
  summary_.identifiable[key] = identifiable;
  if (p.interval_95) summary_.interval_95[key] = *p.interval_95;
  if (!p.u) return;
  if (p.channel.empty()) {
    summary_.shared_uncertainty[p.name] = *p.u;
  } else {
    summary_.channel_uncertainty[p.channel][p.name] = *p.u;
  }
}

void Assembly::add_shape() {
  Material& m = out_.material;
  for (const FittedParameter& p : shape_rows(problem_, best_.point, u_)) {
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

// Whether all columns of a coefficient read the shape.
bool Assembly::is_lobe(std::size_t coefficient) const {
  const std::vector<BasisColumn>& columns = problem_.basis->columns();
  return std::all_of(columns.begin(), columns.end(),
                     [&](const BasisColumn& c) { return c.coefficient != coefficient || c.reads_shape; });
}

void Assembly::add_coefficient(std::size_t c, std::size_t coefficient) {
  const auto j = static_cast<Eigen::Index>(coefficient);
  const ProblemChannel& channel = problem_.channels[c];
  const std::string& name = problem_.basis->coefficients()[coefficient].name;
  FittedParameter p = parameter_row(name, channel.name, best_.point.coefficients[c][j], channel.lower[j],
                                    channel.upper[j], u_.coefficients[c][coefficient]);
  // A lobe whose width nobody can tell is no lobe whose strength anybody can. (Grooves that nobody can tell from a flat
  // surface still have their albedo.)
  const bool width_unknown = problem_.model == surface_model && !out_.material.surface.slope;
  if (width_unknown && name != name_of(Coefficient::rho) && is_lobe(coefficient) && p.value != 0.0) {
    p.value.reset();
  }
  // How strong a lobe of unknown width may be is not known either.
  if (width_unknown && is_lobe(coefficient)) leave_without_uncertainty(p);
  // An uncertainty beyond both the value and 1 says nothing of a coefficient whose scale is 1. Where all that it adds
  // to the scan is less than the residual of one reading, it is not determined; else it is so only apart from its
  // companions.
  const bool says_nothing = p.value && p.u && *p.u > std::max(1.0, *p.value);
  const double noise2 = out_.loss / static_cast<double>(out_.samples * problem_.channels.size());
  if (says_nothing && *p.value * *p.value * l_.by_coefficient[c].col(j).squaredNorm() < noise2) {
    p.value.reset();
    leave_without_uncertainty(p);
  } else if (says_nothing) {
    out_.warnings.push_back(p.name + " of " + p.channel +
                            " is not determined apart from the others: its uncertainty exceeds its value; fix it or "
                            "another parameter of its component");
  }
  record(p, p.value.has_value() && !says_nothing);
  out_.material.channels[c].set_coefficient(name, p.value);
}

// The material must say nothing that the scan does not determine, and still be one: what vanished in the scan leaves
// the model.
void Assembly::leave_out_undetermined() {
  Material& m = out_.material;
  if (m.components.has(Effect::coh) && !m.surface.sigma_um) {
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
    for (std::size_t i = 0; i < problem_.samples(); ++i) {
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

void Assembly::warn_of_surface() {
  const Surface& s = out_.material.surface;
  if (!s.slope) {
    if (problem_.shape_index("slope")) {
      out_.warnings.emplace_back(
          "slope is not determined: no directional part (dd, fs) is left in the fit; leave these out of the "
          "components, "
          "or measure near the mirror direction");
    }
    out_.material.components.erase(Effect::coh);
    return;
  }
  if (!s.sigma_um && !problem_.basis->has_length()) {
    out_.notes.emplace_back(
        "sigma and tau enter only as slope = sigma/tau, so neither is determined alone; give a measured one (--fix "
        "sigma_um=...), or include coh or the distribution he-torrance");
  }
  const FittedParameter& slope = out_.parameters.front();
  if (slope.at_lower || slope.at_upper) {
    out_.warnings.push_back(
        std::string("slope ended on its ") + (slope.at_lower ? "lower" : "upper") +
        " bound: the scan does not resolve the lobe, or the model does not describe it; look at the plot");
  } else if (slope.value && slope.u && *slope.u > 0.5 * *slope.value) {
    out_.warnings.emplace_back(
        "slope is weakly determined (u above half its value): the directional part is small or was hardly sampled; "
        "measure nearer to the mirror direction, or leave dd out");
  }
}

void Assembly::warn_of_peer() {
  for (const FittedParameter& p : out_.parameters) {
    if (!p.channel.empty()) break;
    if (p.at_lower || p.at_upper) {
      out_.warnings.push_back(p.name + " ended on its " + (p.at_lower ? "lower" : "upper") +
                              " bound: the scan does not resolve the lobe, or the model does not describe it");
    } else if (!p.value) {
      out_.warnings.push_back(p.name + " is not determined: the lobe that it shapes is not in this scan");
    }
  }
}

void Assembly::add_warnings() {
  if (!out_.converged)
    out_.warnings.emplace_back(
        "the fit did not converge; look at the plot and at the bounds, and try fewer components");
  if (problem_.model == surface_model) {
    warn_of_surface();
    leave_out_undetermined();
  } else {
    warn_of_peer();
  }
  ByName on_lower;
  ByName on_upper;
  for (const FittedParameter& p : out_.parameters) {
    if (p.channel.empty() || p.fixed) continue;
    if (p.at_lower) on_lower[p.name].push_back(p.channel);
    if (p.at_upper) on_upper[p.name].push_back(p.channel);
    if (!p.value) {
      out_.warnings.push_back(
          p.channel + "." + p.name +
          " is not determined: no reading of the scan depends on it alone; leave its component out, "
          "or fix it");
    }
  }
  const std::size_t channels = problem_.channels.size();
  if (!on_lower.empty()) {
    out_.notes.push_back("on the lower bound: " + listed(on_lower, channels) +
                         "; the uncertainties of the others hold with these where they are");
  }
  if (!on_upper.empty()) {
    out_.warnings.push_back("on the upper bound: " + listed(on_upper, channels) +
                            "; check the scan's absolute scale and the refractive index, or widen the bound (--bound "
                            "NAME=MIN:MAX)");
  }
  if (out_.negative_values > 0) {
    out_.notes.push_back(std::to_string(out_.negative_values) +
                         " negative readings were kept: noise around zero, which must not be cut off");
  }
  if (problem_.components.has(Effect::fs) && problem_.weighting == Weight::cosine) {
    const bool weak = std::any_of(out_.parameters.begin(), out_.parameters.end(), [](const FittedParameter& p) {
      return p.name == "k_fs" && p.value && p.u && *p.u > 0.1 * *p.value;
    });
    if (weak)
      out_.notes.emplace_back(
          "k_fs is weak under the cosine-weighted loss, which gives grazing incidence little say; the loss is the "
          "limit, not the data");
  }
}

}  // namespace

FitResult assemble(const Problem& problem, const Scan& scan, const Polished& best) {
  return Assembly(problem, scan, best).result();
}

}  // namespace goniofit
