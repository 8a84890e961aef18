#include "peers/ward.h"

#include "peers/lobe_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_ward() {
  return make_lambert_and_lobe<Ward>(OpticsFactor::one, 1.0, {width_parameter("alpha")});
}

std::unique_ptr<const Basis> make_ward_anisotropic() {
  return make_lambert_and_lobe<WardAnisotropic>(OpticsFactor::one, 1.0,
                                                {width_parameter("alpha_x"), second_width_parameter("alpha_y")});
}

}  // namespace goniofit
