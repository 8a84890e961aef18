#include "peers/ward.h"

#include "basis/pointwise_basis.h"

namespace goniofit {

namespace {

template <class Model>
std::unique_ptr<const Basis> make(std::vector<ShapeParameter> shape) {
  return std::make_unique<PointwiseBasis<Model>>(
      std::vector<BasisCoefficient>{diffuse_coefficient(), {"k_s", 0.0, 1.0}},
      std::vector<BasisColumn>{diffuse_column(), {1, OpticsFactor::one, true}}, std::move(shape));
}

}  // namespace

std::unique_ptr<const Basis> make_ward() { return make<Ward>({width_parameter("alpha")}); }

std::unique_ptr<const Basis> make_ward_anisotropic() {
  return make<WardAnisotropic>({width_parameter("alpha_x"), second_width_parameter("alpha_y")});
}

}  // namespace goniofit
