#include "peers/lafortune.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

namespace {

// The first lobe is the broadest; the others are searched as so many times the exponent of the one before. Otherwise
// every fit would be found again in each order of the lobes.
template <std::size_t lobes>
std::unique_ptr<const Basis> make() {
  std::vector<BasisCoefficient> coefficients{diffuse_coefficient()};
  std::vector<BasisColumn> columns{diffuse_column()};
  std::vector<ShapeParameter> shape;
  for (std::size_t i = 0; i < lobes; ++i) {
    const std::string number = lobes == 1 ? "" : "_" + std::to_string(i + 1);
    coefficients.push_back({"k_s" + number, 0.0, std::numeric_limits<double>::infinity()});
    columns.push_back({1 + i, OpticsFactor::one, true});
    ShapeParameter exponent = exponent_parameter("exponent" + number, 1.0, 1e6);
    if (i > 0) {
      exponent.probes = {4.0, 16.0, 64.0};
      exponent.relative_to = static_cast<std::ptrdiff_t>(2 * i - 2);
    }
    shape.push_back(std::move(exponent));
    ShapeParameter height{"normal_to_grazing" + number, "", 1e-3, 1e3, 0.0, 0.7};
    height.probes = lobes == 1 ? std::vector<double>{0.03, 0.1, 0.3, 1.0, 3.0, 10.0} : std::vector<double>{0.2, 1.0};
    shape.push_back(std::move(height));
  }
  return std::make_unique<PointwiseBasis<Lafortune<lobes>>>(std::move(coefficients), std::move(columns),
                                                            std::move(shape));
}

}  // namespace

std::unique_ptr<const Basis> make_lafortune(std::size_t lobes) {
  switch (lobes) {
    case 1:
      return make<1>();
    case 2:
      return make<2>();
    case 3:
      return make<3>();
    default:
      return nullptr;
  }
}

}  // namespace goniofit
