#pragma once
// What accuracy costs in time: every model, every tier of every term and every subset of the effects, its time beside
// its error. The paper's table 4, Schlick's epsilon and gamma and Oren & Nayar's three forms, asked again.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../brdf/material.h"
#include "../peers/approximation_quality.h"
#include "../support/instruction_set.h"
#include "error_samples.h"
#include "model_error.h"
#include "timing.h"

namespace goniofit {

/// `model`: whole models; peers are fitted to the reference first. The four terms: its tiers, with the error of the
/// term by itself and the time of dd with it, all else as published; of the distribution the error of dd against the
/// series. `oren_nayar`: the three forms of the rough effect against the integral. `effects`: their subsets against all
/// of them, terms as published. `fit`: what fitting with these terms gives, in time, loss and slope.
enum class TradeoffGroup : std::uint8_t {
  model,
  fresnel,
  shadowing,
  effective_roughness,
  distribution,
  oren_nayar,
  effects,
  fit
};
inline constexpr std::array all_tradeoff_groups{TradeoffGroup::model,        TradeoffGroup::fresnel,
                                                TradeoffGroup::shadowing,    TradeoffGroup::effective_roughness,
                                                TradeoffGroup::distribution, TradeoffGroup::oren_nayar,
                                                TradeoffGroup::effects,      TradeoffGroup::fit};
[[nodiscard]] std::string_view name_of(TradeoffGroup) noexcept;
template <>
[[nodiscard]] std::optional<TradeoffGroup> parse_name<TradeoffGroup>(std::string_view name) noexcept;
template <>
[[nodiscard]] std::string names_of<TradeoffGroup>();

/// A term by itself, one value after the other, over uniform cosines.
struct TermFigures {
  ApproximationError error;
  Timing time;        ///< of the term's function alone; ratio: over the exact one's
  double gain = 1.0;  ///< Schlick's gamma: the exact function's time over this one's
};

/// Fitting the scan that the reference gives, without noise: what is lost is the terms'.
struct FitFigures {
  double ms = 0.0, loss = 0.0;
  double slope = 0.0, slope_error = 0.0;  ///< relative to the truth
  bool converged = false;
};

struct TradeoffRow {
  TradeoffGroup group{};
  std::string name, material;
  std::string reference;  ///< what the errors are against
  std::string model;      ///< "surface" or a peer's name
  std::optional<Terms> terms{};
  EffectSet effects{};
  std::string arithmetic;  ///< "double", "float", "double, one by one"
  double tolerance = 0.0;
  bool shadowing_shortcut = false;
  std::string note{};
  Timing time{};                             ///< of one evaluation in the first channel
  std::string ratio_to{};                    ///< the row of its table that time.ratio is over
  std::optional<double> ns_per_direction{};  ///< all channels of one pair of directions
  ModelError error{};                        ///< of single terms l1, rms_relative and max_relative alone
  bool pareto = false;  ///< of the rows of its group and material none is both faster and as right (by l1)
  std::optional<TermFigures> term{};
  std::optional<FitFigures> fit{};
};

struct TradeoffSettings {
  std::vector<TradeoffGroup> groups{all_tradeoff_groups.begin(), all_tradeoff_groups.end()};
  std::size_t pairs = 4096;  ///< that are timed at once
  TimingSettings timing{};
  ErrorSettings errors{};
  InstructionSet instructions = best_instruction_set();
  std::uint64_t seed = 1;
  /// Peers that are fitted and measured beside the surface models; unset: all that can tell the material.
  std::optional<std::vector<std::string>> peers{};
  /// Few repetitions and directions: for trying out.
  [[nodiscard]] static TradeoffSettings quick();
};

struct Tradeoff {
  std::string machine, reference;
  InstructionSet instructions{};
  TradeoffSettings settings;
  std::vector<TradeoffRow> rows;
};

/// Told what is being measured. Must not throw.
using TradeoffProgress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

/// Errors are functions of the materials and the seed; times are not. Throws Error (bad_input) for an invalid material
/// and for a peer, and for a peer's name that is none.
[[nodiscard]] Tradeoff measure_tradeoff(const std::vector<Material>& materials, const TradeoffSettings& settings,
                                        const TradeoffProgress& progress = {});

/// "dd+uds+fs".
[[nodiscard]] std::string effects_text(EffectSet effects);

}  // namespace goniofit
