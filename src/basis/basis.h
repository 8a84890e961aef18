#pragma once
// The contract between models and everything that evaluates or fits them:
//
//   value = sum over columns of coefficient^power * optics factor * shape factor.
//
// Only the optics factor reads a channel's n and kappa, only the shape factor reads the shape parameters and the
// wavelength, and the coefficients are linear but for the few that stand squared in a second column. That is what makes
// a fit fast and global: shape factors are shared by channels, coefficients are solved, and a search over the few shape
// parameters is all that is left.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "../geometry/pair.h"

namespace goniofit {

/// What a column reads of a channel's optics: nothing, F(u) of the facet that mirrors L into V, T(cos_i) T(cos_r) of
/// light that goes below the surface and comes out again, or 1 - F(u).
enum class OpticsFactor : std::uint8_t { one, fresnel, transmission, remainder };

/// One a channel. A coefficient whose bounds are equal is a constant of the model and no parameter.
struct BasisCoefficient {
  std::string name;
  double lower, upper;  ///< bounds unless told otherwise; infinity for none

  [[nodiscard]] bool constant() const noexcept { return lower == upper; }
};

struct BasisColumn {
  std::size_t coefficient;  ///< index into coefficients()
  OpticsFactor optics;
  bool reads_shape;  ///< false: the shape factor is the same at every value of the shape parameters
  int power = 1;     ///< 1, or 2 where the coefficient enters squared
};

/// Shape parameters are searched and polished as z = ln(value - origin): what they do is a matter of scale.
struct ShapeParameter {
  std::string name;
  std::string unit;
  double lower, upper;  ///< of the value
  double origin = 0.0;
  double step = 0.25;  ///< of z, small enough that a search on such a grid misses no dip of the loss
  /// Beyond this value twice the step will do.
  double coarse_beyond = std::numeric_limits<double>::infinity();
  /// Values to search where other shape parameters are searched too, for one whose effect is broad; empty: a grid of
  /// `step`. Where `relative_to` names another parameter by its index, they are ratios to its value.
  std::vector<double> probes{};
  std::ptrdiff_t relative_to = -1;
};

/// No basis has more columns.
inline constexpr std::size_t most_columns = 8;

class Basis {
 public:
  virtual ~Basis() = default;
  [[nodiscard]] virtual const std::vector<BasisCoefficient>& coefficients() const noexcept = 0;
  [[nodiscard]] virtual const std::vector<BasisColumn>& columns() const noexcept = 0;
  [[nodiscard]] virtual const std::vector<ShapeParameter>& shape_parameters() const noexcept = 0;

  /// Whether the last shape parameter is a length (sigma_um), which alone is compared with the wavelength.
  [[nodiscard]] virtual bool has_length() const noexcept { return false; }
  /// Whether at this pair a shape factor reads that length or the wavelength. Where that is so at few pairs, the search
  /// over the length costs only those.
  [[nodiscard]] virtual bool reads_length(const Pair&) const noexcept { return false; }

  /// The value of the first shape parameter's z up to which all columns that read the shape are nil at this pair: below
  /// 10⁻³⁰ sr⁻¹ per unit of their coefficient, for z throughout and whatever the other parameters are. A search need
  /// not look at a narrow lobe from afar. Minus infinity where there is none.
  [[nodiscard]] virtual double onset(const Pair&) const noexcept { return -std::numeric_limits<double>::infinity(); }

  /// values[column] at one pair; z holds the shape parameters as above. Pairs with a cosine <= 0 are the caller's to
  /// leave out, here and below.
  virtual void shape_factors(const Pair& pair, std::span<const double> z, double wavelength_um,
                             std::span<double> values) const = 0;
  /// values[column][pair].
  virtual void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                             std::span<double* const> values) const = 0;
  /// The same with derivatives[column * parameters + parameter][pair] by z. Those of columns that do not read the shape
  /// are not written.
  virtual void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                             std::span<double* const> values, std::span<double* const> derivatives) const = 0;
};

}  // namespace goniofit
