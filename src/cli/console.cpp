#include "cli/console.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string_view>

#include <fmt/format.h>

#include "support/error.h"

namespace goniofit::cli {
namespace {

bool environment_says(const char* variable, std::string_view value) {
  const char* found = std::getenv(variable);
  return found != nullptr && value == found;
}

bool color_on(int descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  const bool refused = no_color != nullptr && *no_color != '\0';
  return ::isatty(descriptor) == 1 && !refused && !environment_says("TERM", "dumb");
}

}  // namespace

ReportStyle stdout_style() { return {.color = color_on(STDOUT_FILENO), .show_reflectance = true}; }

void to_stdout(const std::function<void(std::ostream&)>& write) {
  errno = 0;
  write(std::cout);
  std::cout.flush();
  if (!std::cout) {
    throw system_error(std::string("cannot write standard output: ") +
                       (errno != 0 ? std::strerror(errno) : "it failed"));
  }
}

void to_stdout(const std::string& text) {
  to_stdout([&text](std::ostream& out) { out << text; });
}

ProgressLine::ProgressLine(std::string label, bool quiet)
    : label_(std::move(label)), shown_(!quiet && ::isatty(STDERR_FILENO) == 1 && !environment_says("TERM", "dumb")) {
  if (!shown_) return;
  ticker_ = std::jthread([this](const std::stop_token& stop) {
    constexpr std::chrono::milliseconds tick{200};
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      draw();
      wake_.wait_for(lock, stop, tick, [] { return false; });
    }
  });
}

ProgressLine::~ProgressLine() {
  if (!shown_) return;
  ticker_.request_stop();
  ticker_.join();
  std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressLine::show(std::string label, std::size_t done, std::size_t total) {
  const std::lock_guard lock(mutex_);
  label_ = std::move(label);
  done_ = done;
  total_ = total;
  if (shown_) draw();
}

void ProgressLine::draw() {
  constexpr std::size_t width = 30;
  std::string text = "\r\x1b[K" + label_;
  if (total_ > 0) {
    const std::size_t filled = width * done_ / total_;
    text += fmt::format(" [{}{}] {}/{}", std::string(filled, '#'), std::string(width - filled, '.'), done_, total_);
  }
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  std::cerr << text << fmt::format(" {:.0f} s", elapsed.count()) << std::flush;
}

}  // namespace goniofit::cli
