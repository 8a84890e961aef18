#pragma once
// The basis of a Lambert part and one lobe: most peers are that.

#include <memory>
#include <utility>
#include <vector>

#include "../basis/pointwise_basis.h"
#include "lobes.h"

namespace goniofit {

/// Model as PointwiseBasis has it, its columns being Lambert's and the lobe's, which has the coefficient k_s.
template <class Model>
[[nodiscard]] std::unique_ptr<const Basis> make_lambert_and_lobe(OpticsFactor optics, double largest_k_s,
                                                                 std::vector<ShapeParameter> shape) {
  return std::make_unique<PointwiseBasis<Model>>(
      std::vector<BasisCoefficient>{diffuse_coefficient(), {"k_s", 0.0, largest_k_s}},
      std::vector<BasisColumn>{diffuse_column(), {1, optics, true}}, std::move(shape));
}

}  // namespace goniofit
