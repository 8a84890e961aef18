#pragma once
// Small things that the parts of the tile renderer share. Private to it.

#include <array>
#include <cstdint>
#include <vector>

#include "../geometry/direction_batch.h"
#include "pixel_samples.h"
#include "tracer.h"

namespace goniofit {

// What a pair of random numbers of a path is for.
enum Purpose : std::uint64_t { for_pixel, for_choice, for_lobe, for_direction, for_lights };

[[nodiscard]] inline std::array<double, 2> random_pair(std::uint64_t key, std::uint64_t purpose,
                                                       std::uint32_t sample) noexcept {
  return sample_pair(pixel_samples::combined(key, purpose), sample);
}

[[nodiscard]] inline Direction in_frame(const Frame& frame, const Vec3& v) noexcept {
  return {dot(v, frame.x), dot(v, frame.y), dot(v, frame.z)};
}

inline void resize(DirectionBatch& batch, std::size_t n) {
  for (std::vector<double>* part : {&batch.l_x, &batch.l_y, &batch.l_z, &batch.v_x, &batch.v_y, &batch.v_z}) {
    part->resize(n);
  }
}

inline void set(DirectionBatch& batch, std::size_t i, const Direction& l, const Direction& v) {
  batch.l_x[i] = l.x;
  batch.l_y[i] = l.y;
  batch.l_z[i] = l.z;
  batch.v_x[i] = v.x;
  batch.v_y[i] = v.y;
  batch.v_z[i] = v.z;
}

[[nodiscard]] inline Vec3 off_surface(const SurfacePoint& s) noexcept { return s.position + s.clearance * s.normal; }

}  // namespace goniofit
