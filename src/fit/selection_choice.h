#pragma once
// The choice among the sets of effects, over the channels that it is given. selection.h says how.

#include <list>

#include "selection_candidate.h"

namespace goniofit {

struct Choice {
  Selection selection;
  std::list<Candidate> fitted;
};

/// Throws Error (bad_input) like fit().
[[nodiscard]] Choice choose_components(const Scan& scan, const FitSettings& settings);

}  // namespace goniofit
