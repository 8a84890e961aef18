#include "fit/dot.h"

#include <algorithm>
#include <array>

#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define GONIOFIT_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define GONIOFIT_CLONES
#endif

namespace goniofit {

// Partial sums by position rather than one long chain: as many additions in flight as the machine takes, and a smaller
// round-off than a plain loop's.
GONIOFIT_CLONES double dot(const double* a, const double* b, std::size_t n) noexcept {
  constexpr std::size_t lanes = 32;
  std::array<double, lanes> partial{};
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) partial[k] += a[i + k] * b[i + k];
  }
  for (std::size_t k = 0; i < n; ++i, ++k) partial[k] += a[i] * b[i];
  double sum = 0.0;
  for (const double part : partial) sum += part;
  return sum;
}

GONIOFIT_CLONES void add_scaled(double c, const double* a, double* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += c * a[i];
}

GONIOFIT_CLONES void multiply(const double* a, const double* b, double* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] * b[i];
}

namespace {

// Some ten columns of so many rows lie in the first-level cache.
constexpr std::size_t rows_at_once = 512;

}  // namespace

void add_products(const double* const* columns, std::size_t count, std::size_t n, double* out) noexcept {
  for (std::size_t first = 0; first < n; first += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, n - first);
    double* to = out;
    for (std::size_t b = 0; b < count; ++b) {
      for (std::size_t a = 0; a <= b; ++a) *to++ += dot(columns[a] + first, columns[b] + first, rows);
    }
  }
}

void add_products_with(const double* const* columns, std::size_t count, const double* with, std::size_t n,
                       double* out) noexcept {
  for (std::size_t first = 0; first < n; first += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, n - first);
    for (std::size_t a = 0; a < count; ++a) out[a] += dot(columns[a] + first, with + first, rows);
  }
}

}  // namespace goniofit
