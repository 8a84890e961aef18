// Writes the truth tables: goniofit_truth_tables [FOLDER], by default the source folder of this file.
//
//   ordinary.csv            ten thousand rows, 20 significant digits
//   hard.csv                the corners, 25 significant digits
//   lobe_sum.csv            ln W(g, x) of He et al. and its logarithmic derivatives, 25 significant digits
//   oren_nayar_integral.csv Oren & Nayar's V-cavity integral, 13 significant digits with an estimate of its error
//
// Columns: definitions.h. Minutes on two cores.

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "inputs.h"
#include "side_tables.h"

namespace {

using namespace goniofit::truth;

/// line(0), line(1) ... line(n - 1), by two threads.
std::vector<std::string> lines_of(std::size_t n, const std::function<std::string(std::size_t)>& line) {
  std::vector<std::string> lines(n);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::atomic<bool> failed{false};
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < n; i = next++) lines[i] = line(i);
    } catch (...) {
      if (!failed.exchange(true)) failure = std::current_exception();
      next = n;
    }
  };
  std::thread other(work);
  work();
  other.join();
  if (failure) std::rethrow_exception(failure);
  return lines;
}

void write(const std::filesystem::path& path, const std::string& header, const std::vector<std::string>& lines) {
  std::ofstream out(path, std::ios::binary);
  out << header << '\n';
  for (const std::string& line : lines) out << line << '\n';
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path.string());
  std::printf("%s: %zu rows\n", path.c_str(), lines.size());
}

void write_rows(const std::filesystem::path& path, Table table, const std::vector<Inputs>& rows) {
  write(path, joined(header(table)),
        lines_of(rows.size(), [&](std::size_t i) { return joined(cells(table, rows[i])); }));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : GONIOFIT_TRUTH_DIR;
    const auto lobes = lobe_inputs();
    write(folder / "lobe_sum.csv", lobe_header(),
          lines_of(lobes.size(), [&](std::size_t i) { return lobe_line(lobes[i]); }));
    const auto rough = integral_inputs();
    write(folder / "oren_nayar_integral.csv", integral_header(),
          lines_of(rough.size(), [&](std::size_t i) { return integral_line(rough[i]); }));
    write_rows(folder / "hard.csv", Table::hard, hard_inputs());
    write_rows(folder / "ordinary.csv", Table::ordinary, ordinary_inputs());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "goniofit_truth_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}
