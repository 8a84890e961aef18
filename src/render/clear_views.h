#pragma once
// Which objects nothing can stand between and a light: for these no shadow rays are needed. A proof by bounding
// spheres, not a guess: what it does not see at once has its rays.

#include <cstddef>
#include <vector>

#include "scene.h"

namespace goniofit {

class ClearViews {
 public:
  explicit ClearViews(const Scene& scene);

  /// Whether every point of the object that faces the light sees all of it.
  [[nodiscard]] bool has(std::size_t object, std::size_t light) const noexcept {
    return clear_[object * lights_ + light] != 0;
  }

 private:
  std::size_t lights_;
  std::vector<std::uint8_t> clear_;
};

}  // namespace goniofit
