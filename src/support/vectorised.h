#pragma once
// One loop compiled for each instruction set, to be chosen when the program runs. For files that are compiled for
// vectorisation.

#include <array>
#include <cstddef>

#include "instruction_set.h"

// One function, for the compiler's own target, where there is no choice to make: instrumented code is not vectorised
// anyway, and three copies of it take the compiler minutes. Nor can code for a processor with more than a level of
// x86-64 has (PCLMUL and SSE4A belong to none) be inlined into functions for that level.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__AVX512F__) && !defined(__PCLMUL__) && !defined(__SSE4A__)
#define GONIOFIT_CHOOSES_INSTRUCTION_SET
#endif
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GONIOFIT_LOOP [[gnu::flatten, gnu::noinline]]
#else
#define GONIOFIT_LOOP
#endif

namespace goniofit {

/// Loop has a struct Arguments and an always_inline static void run(const Arguments&). All that run calls is inlined
/// into these functions, so no function that others link is compiled for instructions that a processor may lack.
template <class Loop>
struct Vectorised {
  using Function = void (*)(const typename Loop::Arguments&);

  GONIOFIT_LOOP static void own(const typename Loop::Arguments& a) { Loop::run(a); }

#ifdef GONIOFIT_CHOOSES_INSTRUCTION_SET
  GONIOFIT_LOOP [[gnu::target("arch=x86-64-v3")]] static void avx2(const typename Loop::Arguments& a) { Loop::run(a); }
  GONIOFIT_LOOP [[gnu::target("arch=x86-64-v4")]] static void avx512(const typename Loop::Arguments& a) {
    Loop::run(a);
  }

  [[nodiscard]] static Function of(InstructionSet set) noexcept {
    constexpr std::array<Function, 3> functions{&own, &avx2, &avx512};
    return functions[static_cast<std::size_t>(set)];
  }
#else
  [[nodiscard]] static Function of(InstructionSet /*set*/) noexcept { return &own; }
#endif
};

}  // namespace goniofit
