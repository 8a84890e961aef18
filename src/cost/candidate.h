#pragma once
// One way to evaluate a material: with which terms, how compiled, in which arithmetic. What is timed, and what has an
// error.

#include <cstdint>
#include <string>
#include <vector>

#include "../brdf/batch_evaluator.h"
#include "error_samples.h"
#include "timing.h"

namespace goniofit {

enum class Arithmetic : std::uint8_t {
  batch_double,
  batch_float,
  scalar  ///< one by one, through Evaluator
};
[[nodiscard]] std::string_view name_of(Arithmetic arithmetic) noexcept;

struct EvaluationCandidate {
  std::string name;
  Material material;
  CompileSettings compile{};
  Arithmetic arithmetic = Arithmetic::batch_double;
  std::string note{};  ///< what a reader should know
};

/// Values of all channels at the directions of ErrorSamples: element channel * size + i. coh is taken apart from the
/// rest, as what it adds to the reflectance at the mirror directions (by channel and incidence).
struct ModelValues {
  std::size_t channels = 0;
  std::vector<double> f;              ///< 1/sr, without coh
  std::vector<double> mirror;         ///< 1/sr at the mirror directions, without coh
  std::vector<double> mirror_energy;  ///< k F S exp(-g)
};
[[nodiscard]] ModelValues model_values(const EvaluationCandidate& candidate, const ErrorSamples& samples);

/// `count` pairs of directions, each uniform over the part of the hemisphere within 85° of the normal.
[[nodiscard]] DirectionBatch random_pairs(std::size_t count, std::uint64_t seed);

/// Evaluates the candidate at all pairs, from unit vectors on: geometry is part of the time. One evaluation is one pair
/// in one channel. The task keeps what it needs but the pairs, which must outlive it.
[[nodiscard]] TimedTask evaluation_task(const EvaluationCandidate& candidate, const DirectionBatch& pairs);

/// The material with its first channel alone.
[[nodiscard]] Material first_channel_of(Material material);

}  // namespace goniofit
