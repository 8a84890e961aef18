#pragma once
// Lambert: f = k_d/pi, the same in every direction.

#include <memory>

#include "lobes.h"

namespace goniofit {

struct Lambert {
  static constexpr std::size_t columns = 1, parameters = 0;
  template <class T, class G>
  static void factors(const BasicPair<G>&, const T* /*z*/, T* values) {
    values[0] = T(white_lambert<G>());
  }
};

[[nodiscard]] std::unique_ptr<const Basis> make_lambert();

}  // namespace goniofit
