#include "support/instruction_set.h"

namespace goniofit {

InstructionSet best_instruction_set() noexcept {
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
  static const InstructionSet best = [] {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) return InstructionSet::avx512;
    if (__builtin_cpu_supports("x86-64-v3")) return InstructionSet::avx2;
    return InstructionSet::sse2;
  }();
  return best;
#else
  return InstructionSet::sse2;
#endif
}

}  // namespace goniofit
