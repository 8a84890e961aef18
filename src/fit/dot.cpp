#include "fit/dot.h"

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

}  // namespace goniofit
