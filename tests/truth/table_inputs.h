#pragma once
// The inputs of a row of the committed tables.

#include <cstddef>

#include "columns.h"
#include "geometry/pair.h"
#include "support/truth_table.h"

namespace goniofit::truth {

[[nodiscard]] inline Inputs inputs_of(const test::TruthTable& table, std::size_t row) {
  Inputs a;
  for (const InputColumn& column : input_columns()) a.*column.value = table.number(row, column.name);
  a.corner = table.corner(row);
  return a;
}

[[nodiscard]] inline AnglePair angles_of(const Inputs& a) { return {a.theta_i, a.phi_i, a.theta_r, a.phi_r}; }

}  // namespace goniofit::truth
