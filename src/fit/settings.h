#pragma once
// What is asked of a fit: the value that recipe and flags are merged into. No file format.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../brdf/material.h"
#include "../scan/reflectance_readings.h"

namespace goniofit {

/// A fixed value, or bounds; unset members keep the default.
struct ParameterSetting {
  std::optional<double> value, min, max;
};

/// Each reading's weight in the loss, beside what the loss itself weighs by: the published cos(theta_i), or 1; on top
/// of either the solid angle that the reading stands for among its neighbours, for scans of uneven sampling.
enum class Weight : std::uint8_t { cosine, none, cosine_solid_angle, solid_angle };
/// What a fit makes least: see fit/loss.h.
enum class Loss : std::uint8_t { cosine_l2, inverse_variance, relative, log1p, cube_root };
enum class RobustKernel : std::uint8_t { none, huber, soft_l1, cauchy, tukey };

/// What standard uncertainties come from: the readings' own, the residuals, or the differences between incidence angles
/// (see fit/spread.h). Automatic is the readings where every channel states theirs, else the residuals.
enum class UncertaintySource : std::uint8_t { readings, residuals, hc3, angles };
/// "readings", "residuals", "incidence angles".
[[nodiscard]] std::string_view name_of(UncertaintySource source) noexcept;

/// Sets what "auto", "readings", "residuals" or "angles" asks for; false for another word.
[[nodiscard]] bool parse_uncertainty(std::string_view word, std::optional<UncertaintySource>& to) noexcept;
inline constexpr std::string_view uncertainty_words = "auto, readings, residuals, hc3 or angles";

/// Readings that a fit leaves out, each rule counted in its report; theta beyond FitSettings::max_theta_deg as well.
struct ExclusionSettings {
  double retro_cone_deg = 0.0;             ///< readings as near to the retro direction as this
  std::optional<double> saturated_from{};  ///< values of at least this, 1/sr, in their own channel
  bool saturated = false;  ///< values of exactly a channel's largest, where more than chance would have it reached it
  bool clamped = false;    ///< values of exactly 0
};
/// What of the optical constants the fit may move, per channel.
enum class FreeOptics : std::uint8_t { none, n, f0 };

struct FitSettings {
  std::string model{surface_model};     ///< or a peer, whose components there are none of
  std::optional<EffectSet> components;  ///< nullopt is "auto"
  Terms terms;
  Forms forms;
  bool anisotropic = false;  ///< two slopes; also where slope_y has a setting
  Weight weight = Weight::cosine;
  Loss loss = Loss::cosine_l2;
  RobustKernel robust = RobustKernel::none;
  std::optional<double> robust_scale;  ///< residual at which the kernel sets in, in the loss's unit; else estimated
  ExclusionSettings exclusions;
  /// Relative standard uncertainty of the instrument's absolute scale, common to all readings; else the scan's.
  std::optional<double> scale_u;
  std::optional<ReflectanceReadings> reflectances;  ///< fitted beside the scan, by their channels' names
  std::optional<UncertaintySource> uncertainty;     ///< nullopt is automatic
  std::vector<double> n, kappa, f0;  ///< none (scan's metadata, else n = 1.5, kappa = 0), one, or one a channel
  FreeOptics free_optics = FreeOptics::none;
  /// By name: a shape parameter (slope, tail ...), tau_um, a coefficient (k_dd, rho ...), n or f0 for every channel, or
  /// "CHANNEL.name" for one.
  std::map<std::string, ParameterSetting> parameters;
  std::optional<double> solid_angle_sr;  ///< else the scan's, else 0.0005
  double max_theta_deg = 90.0;           ///< samples with theta_i or theta_r above are left out; exactly 90 always is
  /// Parameters to profile (fit/likelihood_profile.h): "slope", "k_dd" of every channel, "R.k_dd"; all where empty.
  std::optional<std::vector<std::string>> profile{};
};

/// Bounds unless told otherwise.
inline constexpr double slope_min = 1e-4, slope_max = 10.0;
inline constexpr double sigma_um_min = 1e-3, sigma_um_max = 100.0;
inline constexpr double tail_min = 1.05, tail_max = 200.0;
inline constexpr double facet_slope_deg_min = 0.5;
inline constexpr double n_min = 1e-3, n_max = 100.0;

struct Noise {
  double relative = 0.0;  ///< standard deviation as a part of the value
  double additive = 0.0;  ///< standard deviation in 1/sr

  [[nodiscard]] double sd(double f) const noexcept { return std::hypot(relative * f, additive); }
};

enum class Sampling : std::uint8_t { incidence_plane, hemisphere };

/// The [verify] table of a recipe. Of the bounds only those set are judged, apart from slope_bias and failure_rate.
struct VerifySettings {
  std::filesystem::path truth;
  Noise noise{0.02, 0.0};
  bool known_noise = false;  ///< simulated scans state the noise's standard deviation as their uncertainty
  Sampling sampling = Sampling::hemisphere;
  std::size_t trials = 200;
  double slope_bias = 0.01;  ///< largest relative bias of the slope that passes
  /// Largest bias of any parameter, in units of its mean standard uncertainty.
  std::optional<double> bias;
  /// Smallest and largest coverage that passes.
  std::optional<std::pair<double, double>> coverage_68, coverage_95;
  double failure_rate = 0.0;  ///< largest part of fits that do not converge or end in a wrong minimum
};

struct Recipe {
  std::filesystem::path source;              ///< the recipe itself
  std::string name;                          ///< of the material; empty: the scan's
  std::vector<std::filesystem::path> scans;  ///< may be empty: the command line gives them
  std::vector<std::string> channels;         ///< empty: all
  /// A table that n and kappa are taken from at the channels' wavelengths; settings has no n, kappa and f0 then.
  std::optional<std::filesystem::path> optical_constants;
  std::optional<std::filesystem::path> reflectances;  ///< file of settings.reflectances
  FitSettings settings;
  std::uint64_t seed = 1;
  std::optional<VerifySettings> verify;
};

}  // namespace goniofit
