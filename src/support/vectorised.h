#pragma once
// One loop compiled for each instruction set, to be chosen when the program runs. For files that are compiled for
// vectorisation.

#include <array>
#include <cstddef>

#include "instruction_set.h"

// Instrumented code is not vectorised anyway, and three copies of it take the compiler minutes.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define GONIOFIT_FOR_AVX2 [[gnu::target("arch=x86-64-v3"), gnu::flatten, gnu::noinline]]
#define GONIOFIT_FOR_AVX512 [[gnu::target("arch=x86-64-v4"), gnu::flatten, gnu::noinline]]
#define GONIOFIT_FOR_SSE2 [[gnu::flatten, gnu::noinline]]
#else
#define GONIOFIT_FOR_AVX2
#define GONIOFIT_FOR_AVX512
#define GONIOFIT_FOR_SSE2
#endif

namespace goniofit {

/// Loop has a struct Arguments and an always_inline static void run(const Arguments&). All that run calls is inlined
/// into the three functions, so no function that others link is compiled for instructions that a processor may lack.
template <class Loop>
struct Vectorised {
  using Function = void (*)(const typename Loop::Arguments&);

  GONIOFIT_FOR_SSE2 static void sse2(const typename Loop::Arguments& a) { Loop::run(a); }
  GONIOFIT_FOR_AVX2 static void avx2(const typename Loop::Arguments& a) { Loop::run(a); }
  GONIOFIT_FOR_AVX512 static void avx512(const typename Loop::Arguments& a) { Loop::run(a); }

  [[nodiscard]] static Function of(InstructionSet set) noexcept {
    constexpr std::array<Function, 3> functions{&sse2, &avx2, &avx512};
    return functions[static_cast<std::size_t>(set)];
  }
};

}  // namespace goniofit
