#pragma once
// The arrays of a batch from angles. Private to pair.cpp.

#include <array>
#include <span>

#include "pair.h"

namespace goniofit {

/// Of the arrays of BasicPairBatch in the order of BasicPair.
inline constexpr std::size_t pair_arrays = 22;

/// arrays[k][j] = part k of make_pair(angles[j]), rounded to Real.
template <class Real>
void fill_arrays(std::span<const AnglePair> angles, const std::array<Real*, pair_arrays>& arrays) noexcept;

}  // namespace goniofit
