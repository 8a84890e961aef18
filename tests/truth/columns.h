#pragma once
// From the inputs of one row to the text of its cells. The generator and the test that guards the tables share it.

#include <string>
#include <string_view>
#include <vector>

namespace goniofit::truth {

/// One row's inputs, as definitions.h lists them.
struct Inputs {
  double theta_i = 0, phi_i = 0, theta_r = 0, phi_r = 0;
  double slope = 0.1, slope_y = 0.2, sigma_um = 0.5, wavelength_um = 0.55, tail = 2.5, n = 1.5, kappa = 0;
  double facet_slope_deg = 30;
  double k_dd = 0.5, k_udf = 0.2, k_uds = 0.3, k_fs = 0.4;
  std::string corner;
};

/// The numeric inputs by column name; the one list that reading and writing go by.
struct InputColumn {
  std::string_view name;
  double Inputs::*value;
};
[[nodiscard]] const std::vector<InputColumn>& input_columns();

enum class Table { ordinary, hard };
inline constexpr int ordinary_digits = 20;
inline constexpr int hard_digits = 25;

/// The header of a table, inputs first, `corner` last.
[[nodiscard]] std::vector<std::string> header(Table table);

/// The cells of a row in the order of its header.
[[nodiscard]] std::vector<std::string> cells(Table table, const Inputs& inputs);

/// The shortest decimal that reads back as the same double.
[[nodiscard]] std::string shortest(double value);

/// "a,b,c".
[[nodiscard]] std::string joined(const std::vector<std::string>& cells);

}  // namespace goniofit::truth
