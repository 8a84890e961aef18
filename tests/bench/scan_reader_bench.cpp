// Reading a large spectral scan: time, throughput, and the peak of memory against the numbers' own size.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "io/scan_reader.h"
#include "support/paths.h"

namespace goniofit {
namespace {

constexpr std::size_t angle_columns = 4;

// Removed when the program ends.
const test::ScratchDir& scratch() {
  static const test::ScratchDir dir;
  return dir;
}

void append(std::string& text, double value, int decimals) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals).ptr;
  (text += ',').append(digits, end);
}

// Directions with four decimals and values with six, as instruments write them.
std::filesystem::path make_scan(std::size_t rows, std::size_t bands) {
  std::filesystem::path path = scratch() / (std::to_string(rows) + "x" + std::to_string(bands) + ".csv");
  if (std::filesystem::exists(path)) return path;
  std::ofstream out(path);
  out << "idx,theta_i,phi_i,theta_r,phi_r";
  for (std::size_t band = 0; band < bands; ++band) out << ',' << 400 + 10 * band << "nm";
  out << '\n';
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::string line;
  for (std::size_t row = 0; row < rows; ++row) {
    line = std::to_string(row);
    for (const double range : {90.0, 360.0, 90.0, 360.0}) append(line, range * uniform(random), 4);
    for (std::size_t band = 0; band < bands; ++band) append(line, uniform(random), 6);
    out << line << '\n';
  }
  return path;
}

// Resident memory as the kernel counts it, in bytes: "VmHWM" is the peak since it was last reset.
double memory_status(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0.0;
    if (word == key + ":" && status >> kibibytes) return 1024.0 * kibibytes;
  }
  return 0.0;
}

void reset_peak() {
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << '5';
}

void read_large_scan(benchmark::State& state) {
  const auto rows = static_cast<std::size_t>(state.range(0));
  const auto bands = static_cast<std::size_t>(state.range(1));
  const std::filesystem::path path = make_scan(rows, bands);
  double peak = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    reset_peak();
    const double before = memory_status("VmRSS");
    state.ResumeTiming();
    Scan scan = read_scan(path, {.ignore_unknown_columns = true});
    benchmark::DoNotOptimize(scan);
    state.PauseTiming();
    peak = std::max(peak, memory_status("VmHWM") - before);
    scan = {};
    state.ResumeTiming();
  }
  const auto numbers = static_cast<double>(rows * (angle_columns + bands));
  state.counters["peak/numbers"] = peak / (numbers * sizeof(double));
  state.counters["numbers/s"] = benchmark::Counter(numbers, benchmark::Counter::kIsIterationInvariantRate);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
}

BENCHMARK(read_large_scan)->Args({1'000'000, 31})->Args({1'000'000, 3})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goniofit
