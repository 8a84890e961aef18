#pragma once
// A basis from one function of one pair of directions: batches are loops over it, derivatives come from dual numbers.

#include <ceres/jet.h>

#include <array>
#include <utility>

#include "basis.h"

namespace goniofit {

/// Model has
///   static constexpr std::size_t columns, parameters;
///   template <class T> static void factors(const Pair&, const T* z, T* values);   // values[column]
/// with z as in ShapeParameter. Columns that do not read the shape are written too.
template <class Model>
class PointwiseBasis : public Basis {
 public:
  PointwiseBasis(std::vector<BasisCoefficient> coefficients, std::vector<BasisColumn> columns,
                 std::vector<ShapeParameter> shape)
      : coefficients_(std::move(coefficients)), columns_(std::move(columns)), shape_(std::move(shape)) {}

  [[nodiscard]] const std::vector<BasisCoefficient>& coefficients() const noexcept override { return coefficients_; }
  [[nodiscard]] const std::vector<BasisColumn>& columns() const noexcept override { return columns_; }
  [[nodiscard]] const std::vector<ShapeParameter>& shape_parameters() const noexcept override { return shape_; }

  void shape_factors(const Pair& pair, std::span<const double> z, double /*wavelength_um*/,
                     std::span<double> values) const override {
    Model::template factors<double>(pair, z.data(), values.data());
  }

  void shape_factors(const PairBatch& pairs, std::span<const double> z, double /*wavelength_um*/,
                     std::span<double* const> values) const override {
    std::array<double, Model::columns> f{};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Model::template factors<double>(pairs[i], z.data(), f.data());
      for (std::size_t j = 0; j < f.size(); ++j) values[j][i] = f[j];
    }
  }

  void shape_factors(const PairBatch& pairs, std::span<const double> z, double /*wavelength_um*/,
                     std::span<double* const> values, std::span<double* const> derivatives) const override {
    using Dual = ceres::Jet<double, Model::parameters == 0 ? 1 : static_cast<int>(Model::parameters)>;
    std::array<Dual, Model::parameters + 1> dual;  // one more: no array is empty
    for (std::size_t k = 0; k < Model::parameters; ++k) dual[k] = Dual(z[k], static_cast<int>(k));
    std::array<Dual, Model::columns> f;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Model::template factors<Dual>(pairs[i], dual.data(), f.data());
      for (std::size_t j = 0; j < f.size(); ++j) {
        values[j][i] = f[j].a;
        if (!columns_[j].reads_shape) continue;
        for (std::size_t k = 0; k < Model::parameters; ++k)
          derivatives[j * Model::parameters + k][i] = f[j].v[static_cast<Eigen::Index>(k)];
      }
    }
  }

 private:
  std::vector<BasisCoefficient> coefficients_;
  std::vector<BasisColumn> columns_;
  std::vector<ShapeParameter> shape_;
};

}  // namespace goniofit
