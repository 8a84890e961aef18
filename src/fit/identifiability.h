#pragma once
// What the readings determine of a fit's parameters, and what not.
//
// The Jacobian's rows are divided by the standard deviation of their readings' noise, its columns multiplied by the
// parameters' own sizes: a shape parameter's is a factor e, a coefficient's its value (or a tenth of its range, where
// that is larger; of an unbounded one from 0.1 to 10, whatever noise makes of it), of n it is n - 1, of f0 its value
// (or 0.04). A direction of singular value s then is known to 1/s of the parameters' sizes, whatever loss was fitted:
// below 1 it is weak, its uncertainty exceeding the parameters themselves; a null direction changes no reading at all.
// Parameters on a bound are among the columns, unlike in the uncertainties: what trades for another may have ended
// there by chance.
//
// Singular vectors of equal singular values mix as they like. So directions are read from the projector on the space of
// all of them, which does not: parameters whose entry there exceeds 0.15 belong together.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace goniofit {

/// A combination of two parameters that is known where they are not: their sum, their ratio.
struct KnownCombination {
  std::string text;  ///< "k_udf + 0.93 k_uds", "k_dd / slope^2"
  bool sum = false;  ///< of both with the same factor, to 2 %
  double value = 0.0, u = 0.0;
};

/// Parameters that the readings do not determine, or not apart from each other.
struct OpenDirection {
  std::string channel;             ///< of all coefficients among them; empty where these are of several, or none
  std::vector<std::string> names;  ///< of the parameters: "slope", "k_dd"
  std::vector<std::string> keys;   ///< the same with their channels: "slope", "R.k_dd"
  bool null = false;               ///< no reading depends on it
  double u = 0.0;                  ///< largest standard uncertainty along it, in parameters' sizes; infinity for null
  std::optional<KnownCombination> known{};
};

struct Identifiability {
  std::vector<double> singular_values;  ///< largest first
  double condition = 1.0;               ///< largest by smallest; infinity with a null direction
  std::vector<OpenDirection> open;
  /// Standard uncertainty of each coefficient, by its key, if readings were weighted by their noise: no loss does
  /// better.
  std::map<std::string, double> least_u;
};

}  // namespace goniofit
