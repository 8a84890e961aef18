#include "peers/blinn_phong.h"

#include <limits>

#include "peers/lobe_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_blinn_phong() {
  return make_lambert_and_lobe<BlinnPhong>(OpticsFactor::one, std::numeric_limits<double>::infinity(),
                                           {exponent_parameter("exponent", 0.1, 1e6)});
}

}  // namespace goniofit
