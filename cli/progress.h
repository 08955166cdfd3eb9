// How far a run is: a bar on a terminal, a plain line every few seconds elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shimmer::cli {

class Progress {
 public:
  // what: of which there are `count` ("clips"); finished: those that an earlier run made.
  Progress(std::string what, int64_t count, int64_t finished, bool quiet);
  ~Progress() { End(); }
  Progress(const Progress&) = delete;

  void Step(bool failed = false);  // one more is finished. For one thread at a time
  void End();                      // clears the terminal's line, if there is one

  int64_t failed() const { return failed_; }

 private:
  std::string Line(double seconds) const;

  std::string what_;
  int64_t count_, finished_before_, finished_, failed_ = 0;
  bool quiet_, terminal_, on_line_ = false;
  std::chrono::steady_clock::time_point start_, shown_;
};

// "0:07", "3:25:00".
std::string DurationText(double seconds);

}  // namespace shimmer::cli
