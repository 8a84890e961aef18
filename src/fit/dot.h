#pragma once
// Sums and products of long columns, vectorised at run time for the machine's instruction set.

#include <cstddef>

namespace goniofit {

[[nodiscard]] double dot(const double* a, const double* b, std::size_t n) noexcept;
/// out[i] += c * a[i].
void add_scaled(double c, const double* a, double* out, std::size_t n) noexcept;
/// out[i] = a[i] * b[i].
void multiply(const double* a, const double* b, double* out, std::size_t n) noexcept;

}  // namespace goniofit
