#include "brdf/shape_loop.h"
// shape_loop.h first: it declares the vector functions that the templates below are to use.
#include "batch_loops.h"
#include "terms/fresnel.h"
#include "terms/oren_nayar.h"

namespace goniofit::stability {

namespace {

struct Qualitative {
  [[gnu::always_inline]] inline double operator()(const Pair& p, double slope) const {
    return oren_nayar::qualitative(slope, p);
  }
};
struct FunctionalDirect {
  [[gnu::always_inline]] inline double operator()(const Pair& p, double slope) const {
    return oren_nayar::functional(slope, p).direct;
  }
};
struct FunctionalInterreflection {
  [[gnu::always_inline]] inline double operator()(const Pair& p, double slope) const {
    return oren_nayar::functional(slope, p).interreflection;
  }
};
struct Schlick {
  [[gnu::always_inline]] inline double operator()(const Pair& p, double f0) const {
    return fresnel_schlick(f0, p.one_minus_cos_h);
  }
};
struct SchlickTransmission {
  [[gnu::always_inline]] inline double operator()(const Pair& p, double f0) const {
    return transmission_schlick(1.0 - f0, p.cos_i) * transmission_schlick(1.0 - f0, p.cos_r);
  }
};

template <class F>
GONIOFIT_VECTOR_CLONES void loop(const PairBatch& pairs, double parameter, double* values) {
  const std::size_t n = pairs.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) values[i] = F{}(pairs[i], parameter);
}

template <class F>
PlainLoop both(const char* name) {
  return {name, &loop<F>, [](const Pair& p, double parameter) { return F{}(p, parameter); }};
}

}  // namespace

std::vector<PlainLoop> plain_loops() {
  return {both<Qualitative>("Oren-Nayar qualitative"), both<FunctionalDirect>("Oren-Nayar direct"),
          both<FunctionalInterreflection>("Oren-Nayar interreflection"), both<Schlick>("F schlick"),
          both<SchlickTransmission>("T schlick")};
}

}  // namespace goniofit::stability
