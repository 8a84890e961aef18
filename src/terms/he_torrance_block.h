#pragma once
// Tier `he-torrance`: ln W(g, x) of whole blocks, by vector instructions: see he_torrance_regions.h for how, and
// he_torrance.h for one value with its derivatives.

#include <cstddef>
#include <cstdint>

#include "../support/instruction_set.h"

namespace goniofit {

/// Largest error of ln W: 1e-9 or 1e-4.
enum class HeTorranceAccuracy : std::uint8_t { fine, coarse };

/// Places a call takes at most.
inline constexpr std::size_t he_torrance_block = 256;

/// log_w[i] = ln W(g, x) at (log_g[i], x[i]), x >= 0, i < n <= he_torrance_block; log_w must not
/// overlap the arguments.
/// W below e^-690 may come back as anything below that. What is fitted beforehand takes some 15 ms at the first call.
void log_he_torrance_block(const double* log_g, const double* x, std::size_t n, double* log_w,
                           HeTorranceAccuracy accuracy, InstructionSet instructions);

/// In single precision: within 1e-5 (1 + |ln W|); W below e^-80 may come back as anything below that.
void log_he_torrance_block(const float* log_g, const float* x, std::size_t n, float* log_w,
                           InstructionSet instructions);

}  // namespace goniofit
