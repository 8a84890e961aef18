#pragma once
// Many pairs of directions as unit vectors, in structure-of-arrays: what a renderer has.

#include <vector>

#include "direction.h"

namespace goniofit {

/// All arrays have the same length. Real is double or float.
template <class Real>
struct BasicDirectionBatch {
  std::vector<Real> l_x, l_y, l_z;  ///< to the light
  std::vector<Real> v_x, v_y, v_z;  ///< to the viewer

  void push_back(const Direction& l, const Direction& v) {
    l_x.push_back(static_cast<Real>(l.x));
    l_y.push_back(static_cast<Real>(l.y));
    l_z.push_back(static_cast<Real>(l.z));
    v_x.push_back(static_cast<Real>(v.x));
    v_y.push_back(static_cast<Real>(v.y));
    v_z.push_back(static_cast<Real>(v.z));
  }
  [[nodiscard]] std::size_t size() const noexcept { return l_x.size(); }
};

using DirectionBatch = BasicDirectionBatch<double>;
using FloatDirectionBatch = BasicDirectionBatch<float>;

}  // namespace goniofit
