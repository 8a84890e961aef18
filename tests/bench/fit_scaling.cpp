// What fits cost beside their time: the memory of a very large one, and what two at once take from each other.
//
//   goniofit_fit_scaling large [READINGS]   one fit of a scan of MERL's size and kind, its seconds and its peak memory
//   goniofit_fit_scaling threads [SECONDS]  fits a second of two threads over those of two processes, interleaved

#include <fmt/format.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "fit/fit.h"
#include "support/large_scan.h"
#include "support/materials.h"
#include "synthetic/simulate.h"

namespace goniofit {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void large(std::size_t readings) {
  const Scan scan = test::half_angle_scan(test::laser_paper_73(), readings, 0.02);
  const auto scan_bytes = static_cast<double>(scan.size()) * 8.0 * (4.0 + static_cast<double>(scan.channels.size()));
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak from here on
  const double before = test::process_memory("VmRSS:");
  for (int run = 0; run < 3; ++run) {
    const Clock::time_point start = Clock::now();
    const FitResult r = fit(scan, test::paper_settings());
    fmt::print("{} readings x {} channels: {:.3f} s, slope {:.6f}, converged {}\n", scan.size(), scan.channels.size(),
               seconds_since(start), r.parameters.front().value.value_or(0.0), r.converged);
  }
  const double peak = test::process_memory("VmHWM:");
  fmt::print("scan {:.1f} MB; peak of the process {:.1f} MB, of which the fit's {:.1f} MB: {:.2f} scans\n",
             1e-6 * scan_bytes, 1e-6 * peak, 1e-6 * (peak - before), (peak - before) / scan_bytes);
}

// Fits until the time is over.
std::size_t fits_in(const Scan& scan, double seconds) {
  const Clock::time_point start = Clock::now();
  std::size_t count = 0;
  for (; seconds_since(start) < seconds; ++count) {
    if (!fit(scan, test::paper_settings()).converged) std::abort();
  }
  return count;
}

std::size_t by_threads(const Scan& scan, double seconds) {
  std::array<std::size_t, 2> counts{};
  std::array<std::thread, 2> threads;
  for (std::size_t t = 0; t < 2; ++t) threads[t] = std::thread([&, t] { counts[t] = fits_in(scan, seconds); });
  for (std::thread& t : threads) t.join();
  return counts[0] + counts[1];
}

std::size_t by_processes(const Scan& scan, double seconds) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) std::abort();
  for (int p = 0; p < 2; ++p) {
    if (fork() != 0) continue;
    const std::size_t count = fits_in(scan, seconds);
    _exit(write(ends[1], &count, sizeof count) == sizeof count ? 0 : 1);
  }
  std::size_t sum = 0;
  for (int p = 0; p < 2; ++p) {
    std::size_t count = 0;
    if (read(ends[0], &count, sizeof count) != sizeof count) std::abort();
    sum += count;
    wait(nullptr);
  }
  close(ends[0]);
  close(ends[1]);
  return sum;
}

void threads(double seconds) {
  const Scan scan = simulate(test::laser_paper_73(), Sampling::hemisphere, {0.02, 0.0}, 7);
  std::vector<double> ratios;
  for (int run = 0; run < 9; ++run) {
    const auto processes = static_cast<double>(by_processes(scan, seconds));
    const auto own = static_cast<double>(by_threads(scan, seconds));
    ratios.push_back(own / processes);
    fmt::print("two processes {:.1f} fits/s, two threads {:.1f} fits/s: {:.3f}\n", processes / seconds, own / seconds,
               ratios.back());
  }
  std::sort(ratios.begin(), ratios.end());
  fmt::print("median {:.3f}, least {:.3f}, largest {:.3f}\n", ratios[ratios.size() / 2], ratios.front(), ratios.back());
}

}  // namespace
}  // namespace goniofit

int main(int argc, char** argv) {
  const std::span<char*> words(argv, static_cast<std::size_t>(argc));
  const std::string what = argc > 1 ? words[1] : "";
  const double number = argc > 2 ? std::atof(words[2]) : 0.0;
  if (what == "large") {
    goniofit::large(number > 0.0 ? static_cast<std::size_t>(number) : 1400000);
  } else if (what == "threads") {
    goniofit::threads(number > 0.0 ? number : 2.0);
  } else {
    fmt::print("usage: goniofit_fit_scaling large [READINGS] | threads [SECONDS]\n");
    return 2;
  }
  return 0;
}
