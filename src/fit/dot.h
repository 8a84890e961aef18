#pragma once
// Sums and products of long columns, vectorised at run time for the machine's instruction set.

#include <cstddef>

namespace goniofit {

[[nodiscard]] double dot(const double* a, const double* b, std::size_t n) noexcept;
/// out[i] += c * a[i].
void add_scaled(double c, const double* a, double* out, std::size_t n) noexcept;
/// out[i] = a[i] * b[i]; 0 where that is below 1e-150 in size: its square is 0, and products with it would go through
/// subnormal numbers, which take the processor a hundred times as long.
void multiply(const double* a, const double* b, double* out, std::size_t n) noexcept;

/// out[b (b + 1) / 2 + a] += dot(columns[a], columns[b]) for all a <= b < count: in one pass over the rows, so that
/// they are read from memory once.
void add_products(const double* const* columns, std::size_t count, std::size_t n, double* out);
/// The same of sum weight[i] columns[a][i] columns[b][i].
void add_weighted_products(const double* const* columns, std::size_t count, const double* weight, std::size_t n,
                           double* out);
/// out[a] += dot(columns[a], with).
void add_products_with(const double* const* columns, std::size_t count, const double* with, std::size_t n,
                       double* out) noexcept;
/// out[i] += |row i of the columns, times the matrix|²; the matrix count x directions, by columns.
void add_squared_norms(const double* const* columns, std::size_t count, const double* matrix, std::size_t directions,
                       std::size_t n, double* out) noexcept;

}  // namespace goniofit
