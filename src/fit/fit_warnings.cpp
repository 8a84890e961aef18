#include "fit/fit_warnings.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fit/scan_support.h"

namespace goniofit {

namespace {

// Names of channels, "R and B", or "every channel".
std::string channels_text(const std::vector<std::string>& names, std::size_t all) {
  if (names.size() == all && all > 1) return "every channel";
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

using ByName = std::map<std::string, std::vector<std::string>>;  // parameter, its channels

// "k_dd of every channel, k_uds of R and B".
std::string listed(const ByName& parameters, std::size_t all) {
  std::string text;
  for (const auto& [name, channels] : parameters) {
    text += (text.empty() ? "" : ", ") + name + " of " + channels_text(channels, all);
  }
  return text;
}

// "0.1720 ± 0.0011": the uncertainty to two digits, the value to as many decimals.
std::string with_uncertainty(double value, double u) {
  if (!(u > 0.0) || !std::isfinite(u)) return fmt::format("{:.6g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(u))), 0, 12);
  return fmt::format("{:.{}f} ± {:.{}f}", value, decimals, u, decimals);
}

class Words {
 public:
  Words(FitResult& out, const Problem& problem, const FitPoint& point, const FitEvidence& evidence)
      : out_(out), problem_(problem), point_(point), evidence_(evidence) {}
  void say_all();

 private:
  [[nodiscard]] std::string advice(const OpenDirection& open) const;
  void dark_channels();
  void surface();
  void no_slope();
  void lengths();
  void drawn();
  void peer();
  void opaque();
  void open_directions();
  void forward_scatter();
  void undetermined();
  void bounds();
  void loss_is_the_limit();
  void warn(std::string text) { out_.warnings.push_back(std::move(text)); }
  void note(std::string text) { out_.notes.push_back(std::move(text)); }
  [[nodiscard]] std::size_t channels() const noexcept { return problem_.channels.size(); }

  FitResult& out_;
  const Problem& problem_;
  const FitPoint& point_;
  const FitEvidence& evidence_;
};

void Words::dark_channels() {
  for (const ProblemChannel& c : problem_.channels) {
    if (c.value.maxCoeff() > 0.0) continue;
    warn(fmt::format("channel {} is dark: {}, so it says nothing of the surface; leave it out (--channels)", c.name,
                     c.value.minCoeff() < 0.0 ? "none of its readings is above 0" : "all its readings are 0"));
  }
}

void Words::no_slope() {
  if (!problem_.shape_index("slope")) return;
  if (evidence_.no_lobes && evidence_.no_lobes->chi2 > 0.0) {
    warn(fmt::format(
        "slope is not determined: no directional part (dd, fs) stands clear of the noise; leaving it out costs {:.3g} "
        "in chi-square, which noise alone does with probability {:.2g} (below {:.2g} it would count); leave it out of "
        "the components, or measure near the mirror direction",
        evidence_.no_lobes->chi2, evidence_.no_lobes->p, lobe_level));
  } else {
    warn(
        "slope is not determined: no directional part (dd, fs) is left in the fit; leave these out of the components, "
        "or measure near the mirror direction");
  }
}

// That sigma and tau are only their quotient, with its value.
void Words::lengths() {
  const FittedParameter& slope = out_.parameters.front();
  if (out_.material.surface.sigma_um || problem_.basis->has_length() || !slope.value) return;
  const std::string value = slope.u ? with_uncertainty(*slope.value, *slope.u) : fmt::format("{:.6g}", *slope.value);
  note("sigma and tau enter only as sigma/tau: slope " + value +
       "; so neither is determined alone; give a measured one (--fix sigma_um=...), or include coh or the distribution "
       "he-torrance");
}

void Words::surface() {
  if (!out_.material.surface.slope) return no_slope();
  lengths();
  const FittedParameter& slope = out_.parameters.front();
  if (slope.at_lower || slope.at_upper) {
    warn(std::string("slope ended on its ") + (slope.at_lower ? "lower" : "upper") +
         " bound: the scan does not resolve the lobe, or the model does not describe it; look at the plot");
  } else if (slope.value && slope.u && *slope.u > 0.5 * *slope.value) {
    warn(
        "slope is weakly determined (u above half its value): the directional part is small or was hardly sampled; "
        "measure nearer to the mirror direction, or leave dd out");
  }
}

void Words::peer() {
  for (const FittedParameter& p : out_.parameters) {
    if (!p.channel.empty()) break;
    if (p.at_lower || p.at_upper) {
      warn(p.name + " ended on its " + (p.at_lower ? "lower" : "upper") +
           " bound: the scan does not resolve the lobe, or the model does not describe it");
    } else if (!p.value) {
      warn(p.name + " is not determined: the lobe that it shapes is not in this scan");
    }
  }
}

void Words::opaque() {
  ByName left_out;
  for (const FittedParameter& p : out_.parameters) {
    if (p.has(ParameterFlag::opaque)) left_out[p.name].push_back(p.channel);
  }
  if (left_out.empty()) return;
  const std::size_t first = evidence_.opaque.front();
  warn(
      fmt::format("a metal lets no light below its surface (kappa of {} is {:.3g}), so none comes back from there: {} "
                  "left out; fit its diffuse part as udf, or give kappa = 0",
                  problem_.channels[first].name, problem_.channels[first].optics.kappa, listed(left_out, channels())));
}

// What to do about parameters that trade for each other.
std::string Words::advice(const OpenDirection& open) const {
  const auto has = [&](const char* name) {
    return std::find(open.names.begin(), open.names.end(), name) != open.names.end();
  };
  if (has("slope_y")) return "measure at another phi_i, or fit it as isotropic";
  if (has("k_udf") && has("k_uds")) {
    const std::string missing = missing_for_uds(problem_);
    return missing.empty() ? std::string("leave one of them out")
                           : missing + "; measure at theta_i beyond 60°, or leave one of them out";
  }
  if (has("slope") && has("k_dd")) return "measure nearer to the mirror direction, or fix one of them";
  return "fix one of them, or measure at more incidence angles";
}

// Of one parameter: it is weak by itself. Of more: they trade for each other. Alike in several channels: one sentence.
void Words::open_directions() {
  struct Alike {
    std::vector<std::string> channels, known;
    const OpenDirection* first = nullptr;
  };
  std::map<std::string, Alike> alike;
  for (const OpenDirection& open : out_.identifiability.open) {
    const bool fs_alone = open.names == std::vector<std::string>{std::string(name_of(Coefficient::k_fs))};
    const bool said = fs_alone || (open.names.size() == 1 && open.null);  // by forward_scatter(), undetermined()
    const bool of_no_lobe = std::any_of(open.keys.begin(), open.keys.end(), [&](const std::string& key) {
      return std::any_of(out_.parameters.begin(), out_.parameters.end(), [&](const FittedParameter& p) {
        return (p.channel.empty() ? p.name : p.channel + "." + p.name) == key &&
               (p.has(ParameterFlag::insignificant) || p.has(ParameterFlag::opaque));
      });
    });
    if (said || of_no_lobe) continue;
    const std::vector<std::string>& shown = open.channel.empty() ? open.keys : open.names;
    Alike& group = alike[fmt::format("{}", fmt::join(shown, ", "))];
    if (group.first == nullptr) group.first = &open;
    if (!open.channel.empty()) group.channels.push_back(open.channel);
    if (!open.known) continue;
    const KnownCombination& k = *open.known;
    group.known.push_back((group.channels.empty() ? "" : open.channel + ": ") + (k.sum ? "their sum" : k.text + " =") +
                          " " + with_uncertainty(k.value, k.u));
  }
  for (const auto& [names, group] : alike) {
    const std::string of = group.channels.empty() ? "" : " of " + channels_text(group.channels, channels());
    if (group.first->names.size() == 1) {
      warn(fmt::format("{}{} is not determined: its uncertainty, {:.2g} times its own size, says nothing; {}", names,
                       of, group.first->u, advice(*group.first)));
      continue;
    }
    constexpr std::size_t most = 4;
    std::string known;
    for (std::size_t i = 0; i < std::min(most, group.known.size()); ++i) known += (i == 0 ? "" : ", ") + group.known[i];
    if (group.known.size() > most) known += " ...";
    warn(fmt::format("{}{} trade for each other{}; {}", names, of, known.empty() ? "" : ": only known is " + known,
                     advice(*group.first)));
  }
}

void Words::forward_scatter() {
  std::vector<std::string> weak;
  for (const FittedParameter& p : out_.parameters) {
    if (p.name == name_of(Coefficient::k_fs) && !p.fixed && !p.has(ParameterFlag::opaque) &&
        (!p.identifiable || !p.value)) {
      weak.push_back(p.channel);
    }
  }
  if (weak.empty() || evidence_.no_lobes) return;
  const std::string missing = missing_for_fs(problem_, point_, evidence_.noise);
  warn(fmt::format("k_fs of {} is not determined: {}; leave fs out{}", channels_text(weak, channels()),
                   missing.empty() ? "forward scattering is lost in the noise" : missing,
                   missing.empty() ? "" : ", or measure there"));
}

// What nothing above has spoken of.
void Words::undetermined() {
  for (const FittedParameter& p : out_.parameters) {
    if (p.channel.empty() || p.fixed || p.has(ParameterFlag::opaque) || p.has(ParameterFlag::insignificant)) continue;
    const bool fs = p.name == name_of(Coefficient::k_fs);
    if (!p.value && !fs) {
      warn(p.channel + "." + p.name +
           " is not determined: no reading of the scan depends on it alone; leave its component out, or fix it");
    } else if (p.value && p.u && *p.u > std::max(1.0, *p.value) && !fs) {
      warn(
          p.name + " of " + p.channel +
          " is not determined apart from the others: its uncertainty exceeds its value; fix it or another parameter of "
          "its component");
    }
  }
}

void Words::bounds() {
  ByName on_lower;
  ByName on_upper;
  for (const FittedParameter& p : out_.parameters) {
    if (p.channel.empty() || p.fixed) continue;
    if (p.at_lower) on_lower[p.name].push_back(p.channel);
    if (p.at_upper) on_upper[p.name].push_back(p.channel);
  }
  if (!on_lower.empty()) {
    note("on the lower bound: " + listed(on_lower, channels()) +
         "; the uncertainties of the others hold with these where they are");
  }
  if (!on_upper.empty()) {
    warn("on the upper bound: " + listed(on_upper, channels()) +
         "; check the scan's absolute scale and the refractive index, or widen the bound (--bound NAME=MIN:MAX)");
  }
}

// The published loss gives grazing incidence little say: what weights by the noise itself would make of the same
// readings.
void Words::loss_is_the_limit() {
  const FittedParameter* worst = nullptr;
  double gain = 2.0;
  for (const FittedParameter& p : out_.parameters) {
    const auto least = out_.identifiability.least_u.find(p.channel + "." + p.name);
    const bool fs = p.name == name_of(Coefficient::k_fs) && p.identifiable;
    if (!fs || !p.value || !p.u || *p.u < 0.1 * *p.value || least == out_.identifiability.least_u.end()) continue;
    if (*p.u > gain * least->second) {
      gain = *p.u / least->second;
      worst = &p;
    }
  }
  if (worst == nullptr) return;
  note(
      fmt::format("k_fs is weak under the loss that was fitted, which gives grazing incidence little say: of {} it "
                  "leaves ±{:.2g}, where weights by the scan's own noise would leave ±{:.2g}; the loss is the limit, "
                  "not the data",
                  worst->channel, *worst->u, *worst->u / gain));
}

void Words::say_all() {
  if (!out_.converged) warn("the fit did not converge; look at the plot and at the bounds, and try fewer components");
  dark_channels();
  if (problem_.model == surface_model) {
    surface();
  } else {
    peer();
  }
  opaque();
  open_directions();
  forward_scatter();
  undetermined();
  bounds();
  if (out_.left_out.negative_values > 0) {
    note(std::to_string(out_.left_out.negative_values) +
         " negative readings were kept: noise around zero, which must not be cut off");
  }
  loss_is_the_limit();
  drawn();
}

// What of a very large scan is not from every reading.
void Words::drawn() {
  const std::size_t count = problem_.drawn.rows.size();
  if (count == 0) return;
  const bool by_readings = out_.uncertainty_from == UncertaintySource::readings;
  note(fmt::format(
      "{} of the {} readings, drawn to stand for all, were searched{}; everything else is from all readings", count,
      problem_.readings(), by_readings ? "" : " and tell the residuals' noise and how far intervals reach"));
}

}  // namespace

void add_fit_warnings(FitResult& result, const Problem& problem, const FitPoint& point, const FitEvidence& evidence) {
  Words(result, problem, point, evidence).say_all();
}

}  // namespace goniofit
