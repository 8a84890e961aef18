#pragma once
// What is known of a fit's best point before anything is said of it.

#include <cstddef>
#include <optional>
#include <vector>

#include "identifiability.h"
#include "linear_parts.h"
#include "lobe_significance.h"
#include "model.h"
#include "whitening.h"

namespace goniofit {

struct FitEvidence {
  Linearisation l{};  ///< empty of a problem by parts
  NoiseModel noise{};
  LinearSums sums{};
  Identifiability identifiability{};
  std::optional<LobeTest> no_lobes{};  ///< why the lobes were left out; none where they were not
  std::vector<std::size_t> no_fs{};    ///< channels whose k_fs nothing shows: left out there
  std::vector<std::size_t> opaque{};   ///< channels whose light from below the surface (uds, fs) was left out
};

}  // namespace goniofit
