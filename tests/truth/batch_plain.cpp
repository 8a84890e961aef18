#include "batch_loops.h"
#include "support/lane_math.h"
#include "support/vectorised.h"
#include "terms/fresnel.h"
#include "terms/oren_nayar.h"

namespace goniofit::stability {

namespace {

struct Qualitative {
  template <class T>
  [[gnu::always_inline]] inline T operator()(const BasicPair<T>& p, T slope) const {
    return oren_nayar::qualitative(slope, p);
  }
};
struct Schlick {
  template <class T>
  [[gnu::always_inline]] inline T operator()(const BasicPair<T>& p, T f0) const {
    return fresnel_schlick(f0, p.one_minus_cos_h);
  }
};
struct SchlickTransmission {
  template <class T>
  [[gnu::always_inline]] inline T operator()(const BasicPair<T>& p, T f0) const {
    return transmission_schlick(1.0 - f0, p.cos_i) * transmission_schlick(1.0 - f0, p.cos_r);
  }
};

template <class F>
struct Loop {
  struct Arguments {
    const PairBatch& pairs;
    double parameter;
    double* values;
  };
  [[gnu::always_inline]] static void run(const Arguments& a) {
    const std::size_t n = a.pairs.size();
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i)
      a.values[i] = F{}(a.pairs.template as<Lane<double>>(i), Lane<double>(a.parameter)).v;
  }
};

template <class F>
PlainLoop both(const char* name) {
  return {name,
          [](const PairBatch& pairs, double parameter, double* values) {
            Vectorised<Loop<F>>::of(best_instruction_set())({pairs, parameter, values});
          },
          [](const Pair& p, double parameter) { return F{}(p, parameter); }};
}

}  // namespace

std::vector<PlainLoop> plain_loops() {
  return {both<Qualitative>("Oren-Nayar qualitative"), both<Schlick>("F schlick"),
          both<SchlickTransmission>("T schlick")};
}

}  // namespace goniofit::stability
