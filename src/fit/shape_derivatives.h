#pragma once
// shape_columns with derivatives by ln slope: the loop of brdf/ on Ceres' dual numbers.

#include "../brdf/shape_kernels.h"

namespace goniofit {

/// Any of the pairs (dd, d_dd) and (fs, d_fs) may be null together.
void shape_columns_with_derivatives(const PairBatch& pairs, const ShapeSettings& settings, double log_slope, double* dd,
                                    double* d_dd, double* fs, double* d_fs);

}  // namespace goniofit
