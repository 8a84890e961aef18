#pragma once
// Times that can be compared: all candidates in turn, round by round, so that whatever the machine does meanwhile
// (clock rate, other work) hits all alike.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace goniofit {

/// The compiler must assume that someone reads what `data` points to: work whose result goes there stays.
inline void keep(const void* data) noexcept {
#if defined(__GNUC__)
  asm volatile("" : : "g"(data) : "memory");
#else
  static const void* volatile sink;
  sink = data;
#endif
}

struct TimedTask {
  std::function<void()> run;
  double evaluations = 1.0;  ///< that one run makes
};

struct TimingSettings {
  std::size_t rounds = 21;
  double least_seconds = 5e-4;  ///< of one measurement: a task is repeated within it until it takes that long
  std::uint64_t seed = 1;       ///< of the order of the tasks, another one in each round
};

/// Of one evaluation, in nanoseconds, over the rounds.
struct Timing {
  double median_ns = 0.0, min_ns = 0.0, max_ns = 0.0;
  /// Median over the rounds of this task's time over the baseline's in the same round: drift of the machine cancels.
  double ratio = 1.0;
};

/// Told after each round how many of how many are done. Must not throw.
using RoundProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Each measurement comes after an untimed run of the same task, which fills caches (of tasks too slow for caches to
/// matter, 1 ms a run, in the first round only). `baseline` is an index of tasks. Errors: those of the tasks;
/// usage_error for no rounds.
[[nodiscard]] std::vector<Timing> time_interleaved(std::span<const TimedTask> tasks, std::size_t baseline,
                                                   const TimingSettings& settings, const RoundProgress& progress = {});

/// Reorders the values; the mean of the two in the middle where their number is even. 0 of none.
[[nodiscard]] double median_of(std::vector<double> values);

}  // namespace goniofit
