#include "peers/neumann_neumann.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_neumann_neumann() {
  return std::make_unique<PointwiseBasis<NeumannNeumann>>(
      std::vector<BasisCoefficient>{diffuse_coefficient(), {"k_s", 0.0, 1.0}},
      std::vector<BasisColumn>{diffuse_column(), {1, OpticsFactor::one, true}},
      std::vector<ShapeParameter>{exponent_parameter("exponent", 1.0, 1e6)});
}

}  // namespace goniofit
