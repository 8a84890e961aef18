#include "peers/ggx.h"

#include "peers/lobe_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_ggx() {
  return make_lambert_and_lobe<Ggx>(OpticsFactor::fresnel, 1.0, {width_parameter("alpha")});
}

std::unique_ptr<const Basis> make_ggx_anisotropic() {
  return make_lambert_and_lobe<GgxAnisotropic>(OpticsFactor::fresnel, 1.0,
                                               {width_parameter("alpha_x"), second_width_parameter("alpha_y")});
}

}  // namespace goniofit
