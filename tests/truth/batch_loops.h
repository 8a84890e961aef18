#pragma once
// Vectorised loops over the shape templates, by their settings. he-torrance is no part of them: its polynomials are
// found by the bits of their argument, a gather that does not vectorise.

#include <vector>

#include "brdf/surface_shape.h"

namespace goniofit::stability {

struct BatchLoop {
  ShapeSettings settings;
  void (*run)(const PairBatch& pairs, const SurfaceParameters<double>& surface, double* values);
};

[[nodiscard]] std::vector<BatchLoop> rough_limit_loops();  ///< dd_shape
[[nodiscard]] std::vector<BatchLoop> student_t_loops();    ///< dd_shape
[[nodiscard]] std::vector<BatchLoop> fs_loops();           ///< fs_shape

/// Terms that read the directions and one parameter: facet_slope in radians, or f0.
struct PlainLoop {
  const char* name;
  void (*run)(const PairBatch& pairs, double parameter, double* values);
  double (*scalar)(const Pair& pair, double parameter);
};
[[nodiscard]] std::vector<PlainLoop> plain_loops();

}  // namespace goniofit::stability
