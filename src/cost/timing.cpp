#include "cost/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "support/error.h"
#include "synthetic/random.h"

namespace goniofit {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(const TimedTask& task, std::size_t repeats) {
  const Clock::time_point start = Clock::now();
  for (std::size_t i = 0; i < repeats; ++i) task.run();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double slow_seconds = 1e-3;

struct Measured {
  const TimedTask* task;
  double estimate = 0.0;  // of one run, seconds
  std::size_t repeats = 1;
  std::vector<double> ns;  // of one evaluation, by round
};

// The first run pays for pages and caches; the second is the estimate.
Measured warmed_up(const TimedTask& task, double least_seconds) {
  Measured m{.task = &task, .ns = {}};
  m.estimate = seconds_of(task, 1);
  if (m.estimate < slow_seconds) m.estimate = std::max(seconds_of(task, 1), 1e-9);
  m.repeats = static_cast<std::size_t>(std::clamp(std::ceil(least_seconds / m.estimate), 1.0, 1e6));
  return m;
}

void measure(Measured& m) {
  if (m.estimate < slow_seconds) m.task->run();
  const double per_run = seconds_of(*m.task, m.repeats) / static_cast<double>(m.repeats);
  m.ns.push_back(1e9 * per_run / m.task->evaluations);
}

// Fisher and Yates: the standard library's shuffle is another one in each implementation.
void shuffle(std::vector<std::size_t>& order, RandomStream& random) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
}

Timing summary(const Measured& m, const Measured& baseline) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < m.ns.size(); ++i) ratios.push_back(m.ns[i] / baseline.ns[i]);
  const auto [least, largest] = std::minmax_element(m.ns.begin(), m.ns.end());
  return {median_of(m.ns), *least, *largest, median_of(std::move(ratios))};
}

}  // namespace

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<Timing> time_interleaved(std::span<const TimedTask> tasks, std::size_t baseline,
                                     const TimingSettings& settings, const RoundProgress& progress) {
  if (settings.rounds == 0) throw usage_error("timing: expected at least one round");
  std::vector<Measured> measured;
  measured.reserve(tasks.size());
  for (const TimedTask& task : tasks) measured.push_back(warmed_up(task, settings.least_seconds));
  std::vector<std::size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  RandomStream random(subkey(settings.seed, "order of tasks"));
  for (std::size_t round = 0; round < settings.rounds; ++round) {
    shuffle(order, random);
    for (const std::size_t i : order) measure(measured[i]);
    if (progress) progress(round + 1, settings.rounds);
  }
  std::vector<Timing> result;
  result.reserve(tasks.size());
  for (const Measured& m : measured) result.push_back(summary(m, measured[baseline]));
  return result;
}

}  // namespace goniofit
