#pragma once
// The Li-Torrance family as a basis: the columns of effects.h, coh and dd joined in the one of k_dd.

#include "../brdf/basis.h"

namespace goniofit {

class SurfaceBasis final : public Basis {
 public:
  /// Shape parameters: slope, and sigma_um after it where `components` has coh.
  SurfaceBasis(EffectSet components, const ShapeSettings& settings, double solid_angle_sr);

  [[nodiscard]] const std::vector<BasisColumn>& columns() const noexcept override { return columns_; }
  [[nodiscard]] const std::vector<ShapeParameter>& shape_parameters() const noexcept override { return shape_; }
  [[nodiscard]] bool reads_later_shape(const Pair& pair) const noexcept override;
  void shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                     std::span<double* const> values) const override;
  void shape_factors(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um,
                     std::span<double* const> values, std::span<double* const> derivatives) const override;

 private:
  void add_coherent(const PairBatch& pairs, std::span<const double> log_shape, double wavelength_um, double* values,
                    double* by_slope, double* by_sigma) const;
  [[nodiscard]] double* column_pointer(Coefficient c, std::span<double* const> values) const noexcept;

  EffectSet components_;
  ShapeSettings settings_;
  double solid_angle_sr_;
  std::vector<BasisColumn> columns_;
  std::vector<ShapeParameter> shape_;
};

}  // namespace goniofit
