#pragma once
// The loop over surface_shape.h for dual numbers, vectorised by the compiler with the C library's vector functions
// (relative error a few 1e-16). Private to the files that instantiate it, which are compiled for vectorisation.

// Instrumented code is not vectorised anyway, and three clones of it take the compiler minutes.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
// Tells the compiler that the C library has vector versions of these (libmvec, glibc 2.35).
extern "C" {
__attribute__((simd("notinbranch"))) double asin(double) noexcept;
__attribute__((simd("notinbranch"))) double erfc(double) noexcept;
__attribute__((simd("notinbranch"))) double exp(double) noexcept;
__attribute__((simd("notinbranch"))) double expm1(double) noexcept;
__attribute__((simd("notinbranch"))) double log(double) noexcept;
__attribute__((simd("notinbranch"))) double log1p(double) noexcept;
}
// One clone an instruction set, chosen when the program starts. AVX2 alone would leave FMA out, hence the levels.
#define GONIOFIT_VECTOR_CLONES \
  __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"), flatten, noinline))
#else
#define GONIOFIT_VECTOR_CLONES
#endif

#include "shape_kernels.h"

namespace goniofit::shape_loop {

enum class Want { dd, fs, both };

template <ShadowingTier shadowing, EffectiveRoughnessTier roughness, FsForm form, Want want, class T, class Sink>
[[gnu::always_inline]] inline void run(const PairBatch& pairs, const T& log_slope, double floor_bound, const Sink& dd,
                                       const Sink& fs) {
  constexpr ShapeSettings settings{.shadowing = shadowing, .effective_roughness = roughness, .forms = {.fs = form}};
  const math::FloorAt floor{floor_bound};
  const SurfaceParameters<T> surface{.log_slope = log_slope};
  const std::size_t n = pairs.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const Pair p = pairs[i];
    const SurfaceTerms<T> t = surface_terms(settings, surface, p, floor);
    if constexpr (want != Want::fs) dd.put(i, dd_shape(settings, surface, t, 1.0, p, floor));
    if constexpr (want != Want::dd) fs.put(i, fs_shape(settings, surface, t, p, floor));
  }
}

}  // namespace goniofit::shape_loop
