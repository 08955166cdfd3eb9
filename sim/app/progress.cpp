#include "sim/app/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace shimmer::app {

using Clock = std::chrono::steady_clock;

Progress::Progress(int64_t clips, int64_t finished, bool quiet)
    : clips_(clips),
      finished_before_(finished),
      finished_(finished),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()),
      shown_(start_) {}

void Progress::Clip(bool failed) {
  ++finished_;
  failed_ += failed;
  const auto now = Clock::now();
  const double wait_seconds = terminal_ ? 0.1 : 5;
  if (quiet_ || (std::chrono::duration<double>(now - shown_).count() < wait_seconds && finished_ < clips_))
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
    const auto full = static_cast<size_t>(kBarCells * finished_ / clips_);
    text = "[" + std::string(full, '#') + std::string(kBarCells - full, '.') + "] ";
  }
  const double rate = static_cast<double>(finished_ - finished_before_) / std::max(seconds, 1e-9);
  char figures[120];
  std::snprintf(figures, sizeof figures, "%lld of %lld clips, %.3g/s, %s left",
                static_cast<long long>(finished_), static_cast<long long>(clips_), rate,
                DurationText(static_cast<double>(clips_ - finished_) / rate).c_str());
  text += figures;
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

}  // namespace shimmer::app
