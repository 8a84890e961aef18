#pragma once
// Schlick's models as a basis. The mirror part is the one thing of all peers that depends on the instrument, and few
// pairs see it: those are done again.

#include "../basis/pointwise_basis.h"
#include "../geometry/angles.h"

namespace goniofit {

template <class Model>
class SchlickBasis final : public PointwiseBasis<Model> {
 public:
  SchlickBasis(std::vector<BasisCoefficient> coefficients, std::vector<BasisColumn> columns,
               std::vector<ShapeParameter> shape, double solid_angle_sr)
      : PointwiseBasis<Model>(std::move(coefficients), std::move(columns), std::move(shape)),
        solid_angle_sr_(solid_angle_sr) {}

  void shape_factors(const Pair& pair, std::span<const double> z, double wavelength_um,
                     std::span<double> values) const override {
    if (!sees_mirror(pair)) {
      PointwiseBasis<Model>::shape_factors(pair, z, wavelength_um, values);
      return;
    }
    Model::through_instrument(pair, z.data(), height(pair), values.data());
  }

  void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                     std::span<double* const> values) const override {
    PointwiseBasis<Model>::shape_factors(pairs, z, wavelength_um, values);
    std::array<double, Model::columns> f{};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Pair pair = pairs[i];
      if (!sees_mirror(pair)) continue;
      Model::through_instrument(pair, z.data(), height(pair), f.data());
      for (std::size_t j = 0; j < f.size(); ++j) values[j][i] = f[j];
    }
  }

  void shape_factors(const PairBatch& pairs, std::span<const double> z, double wavelength_um,
                     std::span<double* const> values, std::span<double* const> derivatives) const override {
    PointwiseBasis<Model>::shape_factors(pairs, z, wavelength_um, values, derivatives);
    constexpr std::size_t parameters = Model::parameters;
    using Dual = ceres::Jet<double, static_cast<int>(parameters)>;
    std::array<Dual, parameters> dual;
    for (std::size_t k = 0; k < parameters; ++k) dual[k] = Dual(z[k], static_cast<int>(k));
    std::array<Dual, Model::columns> f;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Pair pair = pairs[i];
      if (!sees_mirror(pair)) continue;
      Model::through_instrument(pair, dual.data(), height(pair), f.data());
      for (std::size_t j = 0; j < f.size(); ++j) {
        values[j][i] = f[j].a;
        for (std::size_t k = 0; k < parameters; ++k)
          derivatives[j * parameters + k][i] = f[j].v[static_cast<Eigen::Index>(k)];
      }
    }
  }

 private:
  // A cone of solid angle dw about the mirror direction reaches as far as |V - R|² = 2 (1 - cos) = dw/pi.
  [[nodiscard]] bool sees_mirror(const Pair& p) const noexcept { return p.mirror_distance2 < solid_angle_sr_ / pi; }
  [[nodiscard]] double height(const Pair& p) const noexcept { return 1.0 / (p.cos_i * solid_angle_sr_); }

  double solid_angle_sr_;
};

}  // namespace goniofit
