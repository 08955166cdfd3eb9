// How far a run is: a bar on a terminal, a plain line every few seconds elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shimmer::app {

class Progress {
 public:
  // finished: clips that an earlier run made.
  Progress(int64_t clips, int64_t finished, bool quiet);
  ~Progress() { End(); }
  Progress(const Progress&) = delete;

  void Clip(bool failed);  // one more clip is finished. For one thread at a time
  void End();              // clears the terminal's line, if there is one

  int64_t failed() const { return failed_; }

 private:
  std::string Line(double seconds) const;

  int64_t clips_, finished_before_, finished_, failed_ = 0;
  bool quiet_, terminal_, on_line_ = false;
  std::chrono::steady_clock::time_point start_, shown_;
};

// "0:07", "3:25:00".
std::string DurationText(double seconds);

}  // namespace shimmer::app
