#include "fit/verdict.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "scan/arrangement.h"

namespace goniofit {

namespace {

std::string percent(double part) {
  return part < 0.1 ? fmt::format("{:.2g} %", 100.0 * part) : fmt::format("{:.0f} %", 100.0 * part);
}

bool is_larger(const ReducedChiSquare& chi) { return chi.value > chi.high; }

// Whether a misfit of any size may be nothing but noise.
bool may_be_noise(const FitDiagnostics& d, double p, bool testable) {
  if (d.chi_square && !is_larger(*d.chi_square)) return true;
  return testable && p > refuting_p;
}

bool is_gross(const FitDiagnostics& d) {
  const Misfit& m = d.misfit;
  const bool gross = m.peak > gross_misfit || m.bulk > gross_misfit || m.typical.value_or(0.0) > gross_misfit;
  return gross && !may_be_noise(d, d.p_runs, d.runs_testable);
}

std::vector<std::size_t> gross_channels(const FitDiagnostics& d) {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < d.channels.size(); ++c) {
    const ChannelDiagnostics& channel = d.channels[c];
    if (channel.misfit.peak > gross_misfit && !may_be_noise(d, channel.runs.p(), channel.runs.testable()))
      out.push_back(c);
  }
  return out;
}

bool is_systematic(const FitDiagnostics& d) {
  const double size = std::max(d.misfit.peak, d.misfit.bulk);
  if (size <= negligible_misfit) return false;
  if (d.runs_testable && d.p_runs <= refuting_p) return true;
  if (d.chi_square) return is_larger(*d.chi_square) && !d.runs_testable;
  return !d.runs_testable && size > untested_misfit;
}

std::string sizes(const Misfit& m) {
  std::string out = fmt::format("it leaves {} of the weighted signal unexplained (root mean square), {} of its sum",
                                percent(m.peak), percent(m.bulk));
  if (m.typical.value_or(0.0) > gross_misfit) {
    out += m.typical_factor() < 1e3
               ? fmt::format(", and half of the readings are off by more than a factor of {:.2g}", m.typical_factor())
               : ", and half of the readings are where it has no light at all, or none is";
  }
  return out;
}

std::string channel_list(const Scan& scan, const std::vector<std::size_t>& channels) {
  constexpr std::size_t most = 6;
  std::string out;
  for (std::size_t i = 0; i < std::min(channels.size(), most); ++i) {
    out += (i == 0 ? "" : ", ") + scan.channels[channels[i]].name;
  }
  return channels.size() > most ? out + fmt::format(" and {} more", channels.size() - most) : out;
}

class Words {
 public:
  Words(const Scan& scan, const Material& material, FitDiagnostics& d) : scan_(scan), material_(material), d_(d) {}
  void reason(const std::vector<std::size_t>& gross);
  void place();
  void randomness();
  void chi_square();
  void reciprocity();
  void outliers();
  void data();

 private:
  template <class... A>
  void say(fmt::format_string<A...> text, A&&... arguments) {
    d_.findings.push_back(fmt::format(text, std::forward<A>(arguments)...));
  }
  [[nodiscard]] const RegionMisfit& at(Region region) const { return d_.regions[static_cast<std::size_t>(region)]; }
  void retro(const RegionMisfit& retro);
  void mirror(const RegionMisfit& mirror);
  /// Channels of which `has` is true.
  template <class Has>
  [[nodiscard]] std::vector<std::size_t> channels(Has&& has) const {
    std::vector<std::size_t> out;
    for (std::size_t c = 0; c < d_.channels.size(); ++c) {
      if (has(d_.channels[c])) out.push_back(c);
    }
    return out;
  }

  const Scan& scan_;
  const Material& material_;
  FitDiagnostics& d_;
};

void Words::reason(const std::vector<std::size_t>& gross) {
  switch (d_.verdict) {
    case FitVerdict::fails:
      say("the model cannot describe this scan: {}", sizes(d_.misfit));
      if (!gross.empty() && gross.size() < d_.channels.size()) {
        const Misfit& worst =
            d_.channels[*std::max_element(
                            gross.begin(), gross.end(),
                            [&](auto a, auto b) { return d_.channels[a].misfit.peak < d_.channels[b].misfit.peak; })]
                .misfit;
        say("it is gross in channel {}: up to {} unexplained there", channel_list(scan_, gross), percent(worst.peak));
      }
      break;
    case FitVerdict::systematic:
      say("the model describes this scan in the main, but the residuals are systematic: {}", sizes(d_.misfit));
      break;
    case FitVerdict::describes:
      say("the model describes this scan: {} of the weighted signal is left unexplained (root mean square){}",
          percent(d_.misfit.peak), d_.runs_testable ? ", and looks like noise" : "");
  }
}

void Words::retro(const RegionMisfit& retro) {
  const std::string part = percent(retro.of_misfit);
  if (retro.excess > 0.5) {
    say("{} of the misfit lies within 10° of the retro direction, where the scan is brighter than the fit: a retro "
        "peak, which no effect here has{}",
        part, material_.components.has(Effect::rough) ? "" : " (rough brightens towards retro, but has no peak there)");
  } else {
    say("{} of the misfit lies within 10° of the retro direction, where instruments block their own light: leave "
        "blocked readings out",
        part);
  }
}

void Words::mirror(const RegionMisfit& mirror) {
  const bool missed_floor = std::max(d_.misfit.typical.value_or(0.0), d_.misfit.bulk) > gross_misfit;
  if (d_.brightness_range > 100.0 && missed_floor) {
    say("{} of the misfit lies within 10° of the mirror direction: the scan has a spike there, {:.2g} times its "
        "median, "
        "over a broad floor of scattered light, and one lobe is not both; {}",
        percent(mirror.of_misfit), d_.brightness_range,
        material_.components.has(Effect::coh)
            ? "a second lobe or a longer tail (--distribution student-t) is missing"
            : "coh (which needs the wavelength), a second lobe or a longer tail (--distribution student-t) is missing");
  } else {
    say("{} of the misfit lies within 10° of the mirror direction, where the scan is {} than the fit: the lobe has "
        "another shape; try --distribution student-t, or coh for a spike in it",
        percent(mirror.of_misfit), mirror.excess > 0.0 ? "brighter" : "darker");
  }
}

// Where most of the misfit sits.
void Words::place() {
  constexpr double most = 0.5;
  if (at(Region::retro).of_misfit > most) retro(at(Region::retro));
  if (at(Region::mirror).of_misfit > most) mirror(at(Region::mirror));
  if (at(Region::forward_grazing).of_misfit > most) {
    say("{} of the misfit lies at forward grazing (theta_r above 70°, away from the mirror direction), where the scan "
        "is {} than the fit: fs, he-torrance's terms, or --max-theta to leave it out",
        percent(at(Region::forward_grazing).of_misfit),
        at(Region::forward_grazing).excess > 0.0 ? "brighter" : "darker");
  }
  if (at(Region::elsewhere).of_misfit > most) {
    say("{} of the misfit lies away from the mirror, the retro direction and grazing: the diffuse part is not the "
        "scan's; compare udf, uds and rough",
        percent(at(Region::elsewhere).of_misfit));
  }
  const bool few = d_.brightest * 20 < d_.readings;
  if (few && d_.misfit.typical.value_or(0.0) > gross_misfit) {
    say("{} of {} values hold nine tenths of the weighted squared signal: the fit is of these, and hardly sees the "
        "others",
        d_.brightest, d_.readings);
  }
}

void Words::randomness() {
  if (!d_.runs_testable) {
    if (d_.verdict == FitVerdict::systematic) {
      say("too few readings lie on lines along theta_r: nothing tells this misfit from noise but its size");
    }
    return;
  }
  std::size_t runs = 0;
  double expected = 0.0;
  for (const ChannelDiagnostics& channel : d_.channels) {
    runs += channel.runs.runs;
    expected += channel.runs.expected_runs();
  }
  if (d_.p_runs > refuting_p) {
    if (d_.misfit.peak > gross_misfit) {
      say("the residuals change sign along theta_r as noise does ({} runs, {:.0f} expected): it is the scan's noise",
          runs, expected);
    }
  } else if (std::max(d_.misfit.peak, d_.misfit.bulk) > negligible_misfit) {
    say("the residuals keep their sign along theta_r: {} runs where noise has {:.0f}", runs, expected);
  }
}

void Words::chi_square() {
  if (!d_.chi_square) return;
  const ReducedChiSquare& chi = *d_.chi_square;
  const std::string value = fmt::format(
      "reduced chi-square {:.3g} with {} degrees of freedom ({:.3g} to {:.3g} where "
      "model and uncertainties are right)",
      chi.value, chi.degrees_of_freedom, chi.low, chi.high);
  if (chi.value > chi.high) {
    say("{}: {}", value,
        d_.runs_testable && d_.p_runs > refuting_p
            ? fmt::format("the residuals look like noise {:.2g} times the uncertainties stated", std::sqrt(chi.value))
            : "the model misses the scan by more than its uncertainties");
  } else if (chi.value < chi.low) {
    say("{}: the uncertainties stated are too large, or common to many readings", value);
  } else {
    say("{}: as it should be", value);
  }
}

void Words::reciprocity() {
  constexpr double worth_saying = 0.02;
  double least = 1e300;
  double most = 0.0;
  for (const ChannelDiagnostics& channel : d_.channels) {
    if (!channel.reciprocity) return;
    least = std::min(least, *channel.reciprocity);
    most = std::max(most, *channel.reciprocity);
  }
  if (most < worth_saying) return;
  const std::string range =
      least < most ? fmt::format("{} to {}, by channel", percent(std::expm1(least)), percent(std::expm1(most)))
                   : percent(std::expm1(most));
  say("the scan itself is not reciprocal: swapped directions differ by {} (median), and a reciprocal model misses half "
      "of that",
      range);
}

void Words::outliers() {
  if (d_.outlier_count == 0) return;
  const bool many = d_.outlier_count > std::max<std::size_t>(10, d_.readings / 100);
  say("{} of {} values lie beyond 6 robust standard deviations of the residuals: {}", d_.outlier_count, d_.readings,
      many ? "too many for outliers; the model misses a part of the scan"
           : "outliers, or a feature too narrow for the model");
}

void Words::data() {
  if (const auto zero = channels([](const auto& c) { return c.clipping.all_zero; }); !zero.empty()) {
    say("all readings are 0 in channel {}: nothing was measured there", channel_list(scan_, zero));
  }
  if (const auto cut = channels([](const auto& c) { return c.clipping.at_zero > 0; }); !cut.empty()) {
    say("readings of exactly 0 in channel {} (up to {} of {}): clamped, perhaps, which biases a fit upwards",
        channel_list(scan_, cut),
        std::max_element(d_.channels.begin(), d_.channels.end(),
                         [](const auto& a, const auto& b) { return a.clipping.at_zero < b.clipping.at_zero; })
            ->clipping.at_zero,
        d_.readings / d_.channels.size());
  }
  for (const std::size_t c : channels([](const auto& x) { return x.clipping.at_maximum > 0; })) {
    say("{} readings of {} share its largest value {:g}: the detector saturated; exclude them (--exclude-saturated)",
        d_.channels[c].clipping.at_maximum, scan_.channels[c].name, d_.channels[c].clipping.maximum);
  }
  const std::vector<double>& theta = scan_.theta_i_deg;
  const bool one = std::all_of(theta.begin(), theta.end(),
                               [&](double other) { return centidegrees(other) == centidegrees(theta.front()); });
  if (one && !theta.empty()) {
    say("one incidence angle only ({:g}°): how the surface reflects at others is the model's word, not the scan's",
        theta.front());
  }
}

}  // namespace

void judge(const Scan& scan, const Material& material, FitDiagnostics& d) {
  const std::vector<std::size_t> gross = gross_channels(d);
  d.verdict = is_gross(d) || !gross.empty() ? FitVerdict::fails
              : is_systematic(d)            ? FitVerdict::systematic
                                            : FitVerdict::describes;
  Words words(scan, material, d);
  words.reason(gross);
  if (d.verdict != FitVerdict::describes) words.place();
  words.randomness();
  words.chi_square();
  if (d.verdict != FitVerdict::describes) words.reciprocity();
  words.outliers();
  words.data();
}

}  // namespace goniofit
