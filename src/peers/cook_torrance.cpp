#include "peers/cook_torrance.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_cook_torrance() {
  return std::make_unique<PointwiseBasis<CookTorrance>>(
      std::vector<BasisCoefficient>{diffuse_coefficient(), {"k_s", 0.0, 1.0}},
      std::vector<BasisColumn>{diffuse_column(), {1, OpticsFactor::fresnel, true}},
      std::vector<ShapeParameter>{width_parameter("m")});
}

}  // namespace goniofit
