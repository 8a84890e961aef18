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
