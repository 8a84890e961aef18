#include "peers/lambert.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_lambert() {
  return std::make_unique<PointwiseBasis<Lambert>>(std::vector<BasisCoefficient>{diffuse_coefficient()},
                                                   std::vector<BasisColumn>{diffuse_column()},
                                                   std::vector<ShapeParameter>{});
}

}  // namespace goniofit
