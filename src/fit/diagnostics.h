#pragma once
// Whether a material describes the scan that it was fitted to, where it does not, and why.
//
// The rule. A misfit is gross where one of three halves is reached, each over the readings used:
//   peak     sqrt(sum w r² / sum w f²) > 1/2, the loss's own measure, which bright lobes rule;
//   bulk     sum w |r| / sum w |f| > 1/2: half of the light is put in the wrong place;
//   typical  median of |r| / max(|f|, |model|) > 1/2: half of the readings are off by more than a factor of 2. Only
//            readings count at which the scan or the model stands above the scan's noise.
// Bright readings rule the loss, so their noise moves the fitted values of dark ones together. That is no misfit: what
// three standard uncertainties of the parameters change a fitted value by is taken off |r| in `typical`, and residuals
// within it have no say in the runs test.
// (f the reading, r the residual, w the weight in the loss.) The model fails to describe the scan where a misfit is
// gross in the scan as a whole, or in one channel by its peak - unless it is noise: the runs test does not refute
// that, or chi-square with the stated uncertainties is no larger than it should be. A misfit that is not gross is
// systematic where noise is refuted and it exceeds 0.1 %, which no gonioreflectometer is better than; where the
// readings lie on too few lines (and have no uncertainties) nothing can refute noise, and a misfit above 5 % is taken
// as systematic. Everything else describes the scan.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../brdf/material.h"
#include "../scan/clipping.h"
#include "../scan/scan.h"
#include "residual_tests.h"
#include "settings.h"

namespace goniofit {

enum class FitVerdict : std::uint8_t { describes, systematic, fails };
[[nodiscard]] std::string_view name_of(FitVerdict verdict) noexcept;

/// Sizes of a misfit as above, parts of 1. Zero where there is no signal.
struct Misfit {
  double peak = 0.0, bulk = 0.0;
  std::optional<double> typical;  ///< none where no reading stands above the noise

  /// Half of the readings are off by more than this factor.
  [[nodiscard]] double typical_factor() const noexcept;
};

struct ChannelDiagnostics {
  Misfit misfit;
  RunsTest runs;    ///< readings in the mirror cone excluded: theirs is coh's, and the instrument's; others as above
  Noise residuals;  ///< their robust spread, of very many of some 100000 evenly along the scan; misfit included
  double noise_floor = 0.0;  ///< 1/sr: thrice the additive noise of the scan itself; 0 where it cannot be told
  Clipping clipping;
  /// Median of |ln(f(i,r) / f(r,i))|; none without swapped pairs. A reciprocal model misses one of a pair by at least
  /// half of it.
  std::optional<double> reciprocity;
};

enum class Region : std::uint8_t { mirror, retro, forward_grazing, elsewhere };
inline constexpr std::size_t region_count = 4;
[[nodiscard]] std::string_view name_of(Region region) noexcept;

/// A part of the hemisphere: V within 10° of the mirror direction, else within 10° of L, else theta_r > 70° on the
/// forward side, else the rest.
struct RegionMisfit {
  std::size_t readings = 0;  ///< directions
  double of_misfit = 0.0;    ///< part of sum w r²
  double of_signal = 0.0;    ///< part of sum w f²
  double excess = 0.0;       ///< sum w r|r| / sum w r², r = f - model: 1 where the scan is above the model throughout
  std::optional<double> typical;
};

struct Outlier {
  std::size_t row = 0, channel = 0;  ///< of the scan
  double value = 0.0, fitted = 0.0;
  double sds = 0.0;  ///< |residual| over its robust standard deviation
};

struct FitDiagnostics {
  FitVerdict verdict = FitVerdict::describes;
  Misfit misfit;
  double p_runs = 1.0;  ///< smallest of the channels', times their number: noise may be common to channels
  bool runs_testable = false;
  std::vector<ChannelDiagnostics> channels;
  std::array<RegionMisfit, region_count> regions{};
  std::optional<ReducedChiSquare> chi_square;  ///< where the scan has uncertainties
  std::vector<Outlier> outliers;               ///< beyond 6 standard deviations, worst first, at most 10
  std::size_t outlier_count = 0;               ///< all of them
  std::size_t readings = 0;                    ///< values: directions used times channels
  std::size_t brightest = 0;                   ///< so few values hold nine tenths of sum w f²
  double brightness_range = 0.0;               ///< largest value over the median of the positive ones
  std::vector<std::string> findings;           ///< the verdict's reason first; a sentence each
};

/// Readings that a fit used.
struct UsedReadings {
  std::vector<std::size_t> rows;              ///< of the scan
  std::vector<std::vector<bool>> left_out{};  ///< by channel and row in `rows`; empty where none of a channel is
};

/// What a fit knows of the readings that it used, in their order.
struct FittedValues {
  const PairBatch* pairs = nullptr;           ///< those of the readings come first; null where nobody holds them
  std::vector<std::vector<double>> fitted{};  ///< [channel][reading], 1/sr
  std::vector<std::vector<double>> open{};    ///< what the parameters' standard uncertainties change these by
};

struct DiagnosticsOptions {
  Weight weight = Weight::cosine;
  std::optional<UsedReadings> used{};    ///< else all with theta below 90 degrees
  std::size_t free_parameters = 0;       ///< that were fitted, for the degrees of freedom
  std::optional<FittedValues> values{};  ///< of the readings `used`; else the material is evaluated
};

/// `material` has the scan's channels. O(n log n), and one evaluation a value and parameter where `options` has none.
[[nodiscard]] FitDiagnostics diagnose(const Scan& scan, const Material& material, DiagnosticsOptions options);

}  // namespace goniofit
