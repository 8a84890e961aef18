#pragma once
// Tier `he-torrance`: ln W(g, x) of whole blocks, by vector instructions: see he_torrance_regions.h for how, and
// he_torrance.h for one value with its derivatives.
//
// ns a value at pairs of random directions, rough to smooth samples of Li and Torrance, one core of a 2.6 GHz server:
// fine 6.6 to 9.1 by AVX-512, 9.3 to 13 by AVX2 (single values 18 to 29, the sum 690 to 1600), coarse 3.4 to 4.7
// and 5.0 to 6.5, float 2.0 to 3.6 and 3.0 to 4.9. Largest errors: 5.7e-10 (695 numbers), 6.4e-5 (123 numbers),
// float 5.1e-6.

#include <cstddef>
#include <cstdint>

#include "../support/instruction_set.h"

namespace goniofit {

/// Largest error of ln W: 1e-9 or 1e-4.
enum class HeTorranceAccuracy : std::uint8_t { fine, coarse };

/// Places are taken in blocks of this many: fewer at a time cost more each.
inline constexpr std::size_t he_torrance_block = 256;

/// log_w[i] = ln W(g, x) at (log_g[i], x[i]), |ln g| <= 690, x >= 0. log_w must not overlap the others. W below e^-690
/// may come back as anything below that. The polynomials are fitted at the first call, some 10 ms. Safe to call from
/// several threads.
void log_he_torrance_block(const double* log_g, const double* x, std::size_t n, double* log_w,
                           HeTorranceAccuracy accuracy, InstructionSet instructions);

/// In single precision: within 1e-5 (1 + |ln W|), |ln g| <= 75; W below e^-80 may come back as anything below that.
void log_he_torrance_block(const float* log_g, const float* x, std::size_t n, float* log_w,
                           InstructionSet instructions);

}  // namespace goniofit
