#include "vector_exp.h"

#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::bench {

namespace {

struct Exponential {
  struct Arguments {
    const double* x;
    double* y;
    std::size_t n;
  };
  [[gnu::always_inline]] static void run(const Arguments& a) {
    const double* const x = a.x;
    double* const y = a.y;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) y[i] = exp(Lane<double>(x[i])).v;
  }
};

}  // namespace

void vector_exp(const double* x, double* y, std::size_t n) {
  Vectorised<Exponential>::of(best_instruction_set())({x, y, n});
}

}  // namespace goniofit::bench
