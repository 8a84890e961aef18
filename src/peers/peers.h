#pragma once
// The models that Li-Torrance is compared with, each a Basis under the name that materials, recipes and the command
// line use. Coefficients, columns, shape parameters and their bounds come from the Basis itself.

#include <memory>
#include <span>
#include <string_view>

#include "../basis/basis.h"

namespace goniofit {

struct PeerInfo {
  std::string_view name;         ///< as in "model" of a material
  std::string_view description;  ///< one line
  std::string_view paper;
};

/// Every peer, from the simplest on. The names do not change.
[[nodiscard]] std::span<const PeerInfo> peer_catalogue() noexcept;

/// nullptr for a name that is not in the catalogue. `solid_angle_sr` is read by Schlick's models alone: the
/// instrument's solid angle, through which their mirror part is seen; 0 leaves that part out. Errors: usage_error if it
/// is negative.
[[nodiscard]] std::unique_ptr<const Basis> make_peer(std::string_view model, double solid_angle_sr = 0.0005);

}  // namespace goniofit
