#pragma once
// Standard output and standard error as the commands use them.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

#include "../report/fit_report.h"

namespace goniofit::cli {

/// Colours on a terminal only, and never against NO_COLOR or TERM=dumb.
[[nodiscard]] ReportStyle stdout_style();

/// Lets `write` fill standard output. Throws Error (system) when it cannot all be written.
void to_stdout(const std::function<void(std::ostream&)>& write);
void to_stdout(const std::string& text);

/// One line of progress on standard error: a bar once its length is known, and the time since the start, ticking.
/// Redrawn in place and gone at the end; nothing at all when standard error is no terminal or `quiet`.
class ProgressLine {
 public:
  ProgressLine(std::string label, bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// What is going on, and that `done` of `total` parts are complete.
  void show(std::string label, std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;
  void draw();

  std::string label_;
  bool shown_;
  std::size_t done_ = 0, total_ = 0;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread ticker_;  // last: it uses all of the above
};

}  // namespace goniofit::cli
