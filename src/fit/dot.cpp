#include "fit/dot.h"

#include <algorithm>
#include <array>
#include <vector>

#include "fit/clones.h"

namespace goniofit {

namespace {

// Partial sums by position rather than one long chain: as many additions in flight as the machine takes, and a smaller
// round-off than a plain loop's.
constexpr std::size_t lanes = 32;
using Lanes = std::array<double, lanes>;

[[gnu::always_inline]] inline void add_lanes(const double* a, const double* b, std::size_t n, Lanes& to) noexcept {
  Lanes partial = to;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) partial[k] += a[i + k] * b[i + k];
  }
  for (std::size_t k = 0; i < n; ++i, ++k) partial[k] += a[i] * b[i];
  to = partial;
}

[[gnu::always_inline]] inline double total(Lanes l) noexcept {
  for (std::size_t k = 0; k < 16; ++k) l[k] += l[k + 16];
  for (std::size_t k = 0; k < 8; ++k) l[k] += l[k + 8];
  return ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
}

// Some ten columns of so many rows lie in the first-level cache.
constexpr std::size_t rows_at_once = 512;

}  // namespace

GONIOFIT_CLONES double dot(const double* a, const double* b, std::size_t n) noexcept {
  Lanes partial{};
  add_lanes(a, b, n, partial);
  return total(partial);
}

GONIOFIT_CLONES void add_scaled(double c, const double* a, double* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += c * a[i];
}

GONIOFIT_CLONES void multiply(const double* a, const double* b, double* out, std::size_t n) noexcept {
  constexpr double nil = 1e-150;
  for (std::size_t i = 0; i < n; ++i) {
    const double product = a[i] * b[i];
    out[i] = product < nil && product > -nil ? 0.0 : product;
  }
}

GONIOFIT_CLONES void add_products(const double* const* columns, std::size_t count, std::size_t n, double* out) {
  std::vector<Lanes> partial(count * (count + 1) / 2, Lanes{});
  for (std::size_t first = 0; first < n; first += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, n - first);
    Lanes* to = partial.data();
    for (std::size_t b = 0; b < count; ++b) {
      for (std::size_t a = 0; a <= b; ++a) add_lanes(columns[a] + first, columns[b] + first, rows, *to++);
    }
  }
  for (std::size_t k = 0; k < partial.size(); ++k) out[k] += total(partial[k]);
}

GONIOFIT_CLONES void add_weighted_products(const double* const* columns, std::size_t count, const double* weight,
                                           std::size_t n, double* out) {
  std::vector<Lanes> partial(count * (count + 1) / 2, Lanes{});
  std::array<double, rows_at_once> weighted;
  for (std::size_t first = 0; first < n; first += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, n - first);
    Lanes* to = partial.data();
    for (std::size_t b = 0; b < count; ++b) {
      const double* const column = columns[b] + first;
      for (std::size_t i = 0; i < rows; ++i) weighted[i] = weight[first + i] * column[i];
      for (std::size_t a = 0; a <= b; ++a) add_lanes(columns[a] + first, weighted.data(), rows, *to++);
    }
  }
  for (std::size_t k = 0; k < partial.size(); ++k) out[k] += total(partial[k]);
}

GONIOFIT_CLONES void add_products_with(const double* const* columns, std::size_t count, const double* with,
                                       std::size_t n, double* out) noexcept {
  for (std::size_t a = 0; a < count; ++a) {
    Lanes partial{};
    add_lanes(columns[a], with, n, partial);
    out[a] += total(partial);
  }
}

namespace {

// Squares are summed up by column first, then row by row: nothing cancels.
GONIOFIT_CLONES void add_squared(const double* const* columns, std::size_t count, const double* by, std::size_t first,
                                 std::size_t rows, double* sum, double* out) noexcept {
  for (std::size_t i = 0; i < rows; ++i) sum[i] = 0.0;
  for (std::size_t a = 0; a < count; ++a) {
    const double* const column = columns[a] + first;
    const double c = by[a];
    for (std::size_t i = 0; i < rows; ++i) sum[i] += c * column[i];
  }
  for (std::size_t i = 0; i < rows; ++i) out[first + i] += sum[i] * sum[i];
}

}  // namespace

void add_squared_norms(const double* const* columns, std::size_t count, const double* matrix, std::size_t directions,
                       std::size_t n, double* out) noexcept {
  std::array<double, rows_at_once> sum;
  for (std::size_t first = 0; first < n; first += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, n - first);
    for (std::size_t p = 0; p < directions; ++p)
      add_squared(columns, count, matrix + p * count, first, rows, sum.data(), out);
  }
}

}  // namespace goniofit
