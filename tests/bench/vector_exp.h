#pragma once
// The unit that the cost of a kernel is told in.

#include <cstddef>

namespace goniofit::bench {

/// y[i] = e^x[i] with the widest vectors of the processor.
void vector_exp(const double* x, double* y, std::size_t n);

}  // namespace goniofit::bench
