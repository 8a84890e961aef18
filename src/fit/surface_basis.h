#pragma once
// The surface family as a basis: the columns of brdf/effects.h, coh and dd joined in the one of k_dd.

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "../basis/basis.h"
#include "../brdf/rough_shape.h"
#include "../brdf/surface_shape.h"

namespace goniofit {

class SurfaceBasis final : public Basis {
 public:
  /// Shape parameters, each where a component reads it: slope, slope_y, tail, facet_slope_deg, sigma_um. Not to be
  /// shared by threads: it remembers what it integrated.
  SurfaceBasis(EffectSet components, const ShapeSettings& settings, double solid_angle_sr);

  [[nodiscard]] const std::vector<BasisCoefficient>& coefficients() const noexcept override { return coefficients_; }
  [[nodiscard]] const std::vector<BasisColumn>& columns() const noexcept override { return columns_; }
  [[nodiscard]] const std::vector<ShapeParameter>& shape_parameters() const noexcept override { return shape_; }
  [[nodiscard]] bool has_length() const noexcept override { return sigma_.has_value(); }
  [[nodiscard]] bool reads_length(const Pair& pair) const noexcept override;
  [[nodiscard]] double onset(const Pair& pair) const noexcept override;

  void shape_factors(const Pair& pair, std::span<const double> z, double wavelength_um,
                     std::span<double> values) const override;
  void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                     std::span<double* const> values) const override;
  void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                     std::span<double* const> values, std::span<double* const> derivatives) const override;

 private:
  using Index = std::optional<std::size_t>;
  /// A column's values and its derivatives, parameter after parameter; null where there is no such column.
  struct Target {
    double* values = nullptr;
    double* const* derivatives = nullptr;
  };
  /// The columns that this basis fills, of one call. Without derivatives asked for, Targets have none.
  struct Targets {
    Target dd, fs, direct, interreflection;
  };

  void add_columns();
  void add_shape();
  [[nodiscard]] Targets targets(std::span<double* const> values, std::span<double* const> derivatives) const;
  template <class T>
  [[nodiscard]] SurfaceParameters<T> parameters(std::span<const double> z) const;
  template <class T>
  void fill_surface(const PairBatch& pairs, std::span<const double> z, double wavelength_um, const Targets& out) const;
  void fill_by_kernel(const PairBatch& pairs, std::span<const double> z, const Targets& out) const;
  void add_coherent(const PairBatch& pairs, std::span<const double> z, double wavelength_um, const Target& dd) const;
  void fill(const PairBatch& pairs, std::span<const double> z, double wavelength_um, std::span<double* const> values,
            std::span<double* const> derivatives) const;
  void fill_rough(const PairBatch& pairs, double facet_slope_deg, const Targets& out) const;
  [[nodiscard]] const std::vector<VCavityTable>& cavities(const PairBatch& pairs) const;

  EffectSet components_;
  ShapeSettings settings_;
  double solid_angle_sr_;
  std::vector<BasisCoefficient> coefficients_;
  std::vector<BasisColumn> columns_;
  std::vector<ShapeParameter> shape_;
  Index dd_, fs_, direct_, interreflection_;            ///< columns
  Index slope_, slope_y_, tail_, facet_slope_, sigma_;  ///< shape parameters
  /// S and sigma_e of the batch and slopes that were asked for last: a search over sigma at given slopes, and every
  /// wavelength, reads the same.
  struct Remembered {
    const double* batch = nullptr;
    std::vector<double> slopes;
    std::vector<SurfaceTerms<double>> terms;
  };
  [[nodiscard]] const std::vector<SurfaceTerms<double>>& remembered_terms(const PairBatch& pairs,
                                                                          std::span<const double> z) const;
  mutable Remembered remembered_;
  mutable std::map<std::array<double, 2>, std::vector<VCavityTable>> cavities_;  ///< by batch
};

}  // namespace goniofit
