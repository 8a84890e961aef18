#pragma once
// Which rows the tables have.

#include <vector>

#include "columns.h"

namespace goniofit::truth {

/// Ten thousand rows by strata: general, in-plane, lobe, mirror, retro, special angles. theta 0-85°, slope 1e-3..1,
/// sigma/lambda 0.01..10, tail 1.2..50, n 1..3, kappa 0..8. The same on every machine.
[[nodiscard]] std::vector<Inputs> ordinary_inputs();

/// The corners, each naming what goes wrong there if done naively.
[[nodiscard]] std::vector<Inputs> hard_inputs();

/// Arguments of W(g, x): g 1e-12 .. 1e8, x/g 0 .. 1e8.
struct LobeInputs {
  double g, x;
};
[[nodiscard]] std::vector<LobeInputs> lobe_inputs();

}  // namespace goniofit::truth
