#pragma once
// Which vector instructions a kernel uses. Kernels are compiled for each and chosen when the program runs.

#include <array>
#include <cstdint>
#include <string_view>

namespace goniofit {

/// avx2 and avx512 stand for the levels x86-64-v3 and x86-64-v4, which have the fused multiply-add besides. On another
/// processor sse2 stands for whatever its compiler takes by default.
enum class InstructionSet : std::uint8_t { sse2, avx2, avx512 };

inline constexpr std::array all_instruction_sets{InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512};

/// The widest that this processor has.
[[nodiscard]] InstructionSet best_instruction_set() noexcept;

[[nodiscard]] constexpr std::string_view name_of(InstructionSet s) noexcept {
  constexpr std::array<std::string_view, 3> names{"SSE2", "AVX2", "AVX-512"};
  return names[static_cast<std::size_t>(s)];
}

}  // namespace goniofit

// A function of this name for each instruction set, in an array that InstructionSet indexes:
//   GONIOFIT_FOR_EACH_INSTRUCTION_SET(name, void, (double* x, std::size_t n), (x, n), body)
// where body is an always_inline function. The attributes go with the function: no inline function of the library is
// compiled for instructions that a processor may lack.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define GONIOFIT_TARGET_AVX2 [[gnu::target("arch=x86-64-v3"), gnu::flatten, gnu::noinline]]
#define GONIOFIT_TARGET_AVX512 [[gnu::target("arch=x86-64-v4"), gnu::flatten, gnu::noinline]]
#define GONIOFIT_TARGET_SSE2 [[gnu::flatten, gnu::noinline]]
#else
// Instrumented code is not vectorised anyway, and three copies of it take the compiler minutes.
#define GONIOFIT_TARGET_AVX2
#define GONIOFIT_TARGET_AVX512
#define GONIOFIT_TARGET_SSE2
#endif
