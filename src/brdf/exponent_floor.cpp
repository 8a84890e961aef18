#include "brdf/shape_kernels.h"

namespace goniofit {

const double exponent_floor = -700.0;

}  // namespace goniofit
