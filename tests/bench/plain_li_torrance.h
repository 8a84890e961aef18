#pragma once
// The model as one writes it down from the paper: what the batch evaluator is compared with.

#include "geometry/direction.h"

namespace goniofit::bench {

struct PlainMaterial {
  double slope, f0, k_dd, k_uds, k_fs;
};

/// dd + uds + fs with S and sigma_e, Schlick's F, by std::pow and std::exp.
[[nodiscard]] double plain_li_torrance(const PlainMaterial& m, const Direction& l, const Direction& v);

}  // namespace goniofit::bench
