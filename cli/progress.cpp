#include "cli/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace shimmer::cli {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, int64_t count, int64_t finished, bool quiet)
    : what_(std::move(what)),
      count_(count),
      finished_before_(finished),
      finished_(finished),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()),
      shown_(start_) {}

void Progress::Step(bool failed) {
  ++finished_;
  failed_ += failed;
  const auto now = Clock::now();
  const double wait_seconds = terminal_ ? 0.1 : 5;
  if (quiet_ || (std::chrono::duration<double>(now - shown_).count() < wait_seconds && finished_ < count_))
    return;
  shown_ = now;
  on_line_ = terminal_;
  const std::string line = Line(std::chrono::duration<double>(now - start_).count());
  std::fprintf(stderr, terminal_ ? "\r%s\033[K" : "%s\n", line.c_str());
}

void Progress::End() {
  if (on_line_) std::fputs("\r\033[K", stderr);
  on_line_ = false;
}

std::string Progress::Line(double seconds) const {
  constexpr int kBarCells = 30;
  std::string text;
  if (terminal_) {
    const auto full = static_cast<size_t>(kBarCells * finished_ / count_);
    text = "[" + std::string(full, '#') + std::string(kBarCells - full, '.') + "] ";
  }
  const double rate = static_cast<double>(finished_ - finished_before_) / std::max(seconds, 1e-9);
  char figures[40];
  std::snprintf(figures, sizeof figures, "%.3g/s, ", rate);
  text += std::to_string(finished_) + " of " + std::to_string(count_) + " " + what_ + ", " + figures +
          DurationText(static_cast<double>(count_ - finished_) / rate) + " left";
  if (failed_ > 0) text += ", " + std::to_string(failed_) + " failed";
  return text;
}

std::string DurationText(double seconds) {
  const auto whole = static_cast<long long>(std::lround(std::min(seconds, 1e12)));
  char text[40];
  if (whole < 3600)
    std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

}  // namespace shimmer::cli
