#include "peers/cook_torrance.h"

#include "peers/lobe_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_cook_torrance() {
  return make_lambert_and_lobe<CookTorrance>(OpticsFactor::fresnel, 1.0, {width_parameter("m")});
}

}  // namespace goniofit
