#pragma once
// The contract between models and the fit: value = sum over columns of coefficient * optics factor * shape factor. A
// fit searches the few shape parameters, solves the coefficients, and knows nothing else of a model.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "../geometry/pair.h"
#include "effects.h"
#include "material.h"
#include "shape_kernels.h"

namespace goniofit {

struct BasisColumn {
  Coefficient coefficient;
  OpticsFactor optics;
  double lower, upper;  ///< bounds of the coefficient unless told otherwise; infinity for none
  bool reads_shape;     ///< false: the shape factor is the same at every value of the shape parameters
};

/// Shape parameters are searched and polished as logarithms: they are positive, and their effect is a matter of scale.
struct ShapeParameter {
  std::string name;
  std::string unit;
  double lower, upper;
};

class Basis {
 public:
  virtual ~Basis() = default;
  [[nodiscard]] virtual const std::vector<BasisColumn>& columns() const noexcept = 0;
  [[nodiscard]] virtual const std::vector<ShapeParameter>& shape_parameters() const noexcept = 0;

  /// Whether at this pair a shape factor reads more than the first shape parameter (a later one, or the wavelength).
  /// Where that is so at few pairs, the search over the later parameters costs only those.
  [[nodiscard]] virtual bool reads_later_shape(const Pair& pair) const noexcept = 0;

  /// values[column][pair]; log_shape holds the logarithms of the shape parameters.
  virtual void shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                             std::span<double* const> values) const = 0;
  /// The same with derivatives[column * parameters + parameter][pair] by the logarithms; null pointers for columns that
  /// do not read the shape.
  virtual void shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                             std::span<double* const> values, std::span<double* const> derivatives) const = 0;
};

}  // namespace goniofit
