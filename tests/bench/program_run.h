// A program that runs as people run it, watched from outside.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace shimmer::bench {

struct ProgramRun {
  double wall_s = 0, cpu_s = 0;  // of the whole process
  double peak_MB = 0;            // largest resident memory
};

// Runs it to its end; watch is called every few milliseconds meanwhile, with the resident memory in MB. What
// it prints is not shown. Throws std::runtime_error where it ends with another code than 0.
ProgramRun RunProgram(const std::vector<std::string>& words,
                      const std::function<void(double seconds, double resident_MB)>& watch);

// Lines of a file by now; 0 where it is not there.
int64_t LinesOf(const std::filesystem::path& file);

}  // namespace shimmer::bench
