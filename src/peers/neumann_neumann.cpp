#include "peers/neumann_neumann.h"

#include "peers/lobe_basis.h"

namespace goniofit {

std::unique_ptr<const Basis> make_neumann_neumann() {
  return make_lambert_and_lobe<NeumannNeumann>(OpticsFactor::one, 1.0, {exponent_parameter("exponent", 1.0, 1e6)});
}

}  // namespace goniofit
