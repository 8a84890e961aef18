#pragma once
// The main job: a scan and settings in, a material and what is to be said of it out.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../brdf/material.h"
#include "../scan/scan.h"
#include "diagnostics.h"
#include "exclusions.h"
#include "identifiability.h"
#include "likelihood_profile.h"
#include "measurement_design.h"
#include "selection.h"
#include "settings.h"

namespace goniofit {

/// What is to be minded of a parameter.
enum class ParameterFlag : std::uint8_t {
  fixed,
  at_bound,
  at_start,       ///< the loss is flat in it: it stayed where the search put it, and has no value
  degenerate,     ///< known only together with others, or to worse than its own size: see identifiability.h
  insignificant,  ///< of lobes that do not stand clear of the noise
  unsupported,    ///< the scan has no readings where it would show
  opaque          ///< of light from below the surface, where none comes back
};
[[nodiscard]] std::string_view name_of(ParameterFlag flag) noexcept;

/// One row of the fit report.
struct FittedParameter {
  std::string name;                     ///< "slope", "sigma_um", "tau_um", "k_dd", "n"
  std::string channel;                  ///< empty for shared ones
  std::string unit;                     ///< "", "um"
  std::optional<double> value;          ///< null: the scan does not determine it
  std::optional<double> u;              ///< standard uncertainty; null where fixed, on a bound or undetermined
  std::optional<double> u_classical{};  ///< the same if all residuals had one variance, s² (JᵀJ)⁻¹: see uncertainty.h
  /// From the readings' own uncertainties as they are, and times the root of the reduced chi-square; with the scale's.
  std::optional<double> u_unscaled{}, u_chi2_scaled{};
  std::optional<double> u_scale{};  ///< the part of u that is the instrument's scale; null where none is stated
  /// What the truth lies in with that probability. On a bound one-sided: from the bound to the limit.
  std::optional<Interval> interval_68{}, interval_95{};
  std::optional<double> coverage_factor{};  ///< k of U = k u, of 95 %
  double lower = 0.0, upper = 0.0;          ///< bounds; infinity for none
  bool fixed = false;
  bool derived = false;  ///< computed from others (tau from slope and sigma)
  bool at_lower = false, at_upper = false;
  bool identifiable = true;  ///< the scan, or the settings, determine it
  std::vector<ParameterFlag> flags{};

  [[nodiscard]] bool has(ParameterFlag flag) const noexcept;
};

/// What was made least.
struct Objective {
  Loss loss = Loss::cosine_l2;
  RobustKernel robust = RobustKernel::none;
  double robust_scale = 0.0;  ///< where there is a kernel
  double value = 0.0;         ///< at the minimum
};

/// Of the estimates of the free parameters, by the covariance that is stated; empty where none is.
struct Correlation {
  std::vector<std::string> names;  ///< "slope", "R.k_dd", in the order of the report
  std::vector<std::vector<double>> matrix;
};

/// Directional-hemispherical reflectance of the fitted material.
struct HemisphericalReflectance {
  double theta_i_deg;
  std::vector<double> by_channel;
};

/// A reflectance that was fitted beside the scan.
struct FittedReflectance {
  double theta_i_deg;
  std::string channel;
  double measured, fitted;
};

struct FitResult {
  Material material;  ///< with its FitSummary
  std::vector<FittedParameter> parameters;
  std::vector<HemisphericalReflectance> reflectance;  ///< filled by add_reflectance
  Weight weight = Weight::cosine;
  std::size_t samples = 0;                             ///< directions used (times channels = residuals)
  std::size_t reflectances = 0;                        ///< directional-hemispherical ones fitted beside them
  std::vector<FittedReflectance> fitted_reflectances;  ///< their values, one a channel
  Exclusions left_out;
  double loss = 0.0, rms = 0.0;  ///< whatever was made least, sum of cos(theta_i) |difference|² over the values used
  Objective objective;
  std::vector<double> channel_rms;     ///< unweighted RMS of the difference, 1/sr, per channel
  std::size_t search_evaluations = 0;  ///< points of the global search
  std::size_t polish_iterations = 0, polish_starts = 0;
  double seconds = 0.0;
  bool converged = false;
  bool components_were_auto = false;
  std::optional<Selection> selection;  ///< how "auto" chose; also the first of the notes
  Identifiability identifiability;
  std::optional<MeasurementDesign> design;  ///< filled by add_measurement_design
  std::vector<LikelihoodProfile> profiles;  ///< those that FitSettings::profile asks for
  UncertaintySource uncertainty_from = UncertaintySource::residuals;
  double scale_u = 0.0;                      ///< relative, of the instrument's scale
  std::optional<double> reduced_chi_square;  ///< of the readings by their own uncertainties
  Correlation correlation;
  std::optional<FitDiagnostics> diagnostics;  ///< whether the material describes the scan; none where it has no values
                                              ///< (a parameter of a peer is open)
  std::vector<std::string> notes;             ///< what was decided on the user's behalf ("auto: ...")
  std::vector<std::string> warnings;          ///< what is wrong or weak, each with what to do next
};

/// Fits `scan` (all of its channels). Deterministic. Scans of more than 100000 readings go part by part where the
/// settings allow it (Problem::Hold), in some three times the scan's memory; the notes say what then is not from all
/// readings. Throws Error (bad_input) where settings and scan contradict each other (unknown parameter, bounds crossed,
/// wavelength missing for coh ...), naming the parameter.
[[nodiscard]] FitResult fit(const Scan& scan, const FitSettings& settings);

/// Fills result.reflectance at the scan's incidence angles (to 0.1 degree; at most `most` of them, evenly chosen), and
/// warns where it passes 1. Apart from fit(), because it costs more than a fit does.
void add_reflectance(FitResult& result, const Scan& scan, std::size_t most = 12);

}  // namespace goniofit
