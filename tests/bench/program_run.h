// A program that runs as people run it, watched from outside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace shimmer::bench {

struct ProgramRun {
  double wall_s = 0, cpu_s = 0;  // of the whole process
  double peak_MB = 0;            // largest resident memory
};

// Runs it to its end; watch is called every few milliseconds meanwhile. What it prints is not shown. Throws
// std::runtime_error where it ends with another code than 0.
ProgramRun RunProgram(const std::vector<std::string>& words,
                      const std::function<void(double seconds)>& watch);

// Lines of a file that grows, none while it is not there. Reads what is new and no more: the program that
// writes it shares the cores with its watcher.
class LineCounter {
 public:
  explicit LineCounter(std::filesystem::path file) : file_(std::move(file)) {}
  int64_t Now();

 private:
  std::filesystem::path file_;
  int64_t bytes_ = 0, lines_ = 0;
};

}  // namespace shimmer::bench
