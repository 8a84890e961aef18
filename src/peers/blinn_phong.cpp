#include "peers/blinn_phong.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_blinn_phong() {
  return std::make_unique<PointwiseBasis<BlinnPhong>>(
      std::vector<BasisCoefficient>{diffuse_coefficient(), {"k_s", 0.0, std::numeric_limits<double>::infinity()}},
      std::vector<BasisColumn>{diffuse_column(), {1, OpticsFactor::one, true}},
      std::vector<ShapeParameter>{exponent_parameter("exponent", 0.1, 1e6)});
}

}  // namespace goniofit
