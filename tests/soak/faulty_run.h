// Runs of the program in which system calls fail, or before one of which it is killed (fail_calls.h). The
// program is started as a copy of the test, which has its libraries loaded already: a tenth of the time.
#pragma once

#include <sys/mman.h>

#include <cerrno>
#include <memory>

#include "sim/app/commands.h"
#include "tests/app/program.h"
#include "tests/soak/fail_calls.h"

namespace shimmer::app {

// The variables of fail_calls.h.
struct Faults {
  fs::path root;
  std::string calls = "all", mode = "once";
  int64_t at = 0;
  int error = EIO;
  fs::path log = {};

  std::map<std::string, std::string> Variables() const {
    return {{"SHIMMER_FAIL_ROOT", root},
            {"SHIMMER_FAIL_CALL", calls},
            {"SHIMMER_FAIL_MODE", mode},
            {"SHIMMER_FAIL_AT", std::to_string(at)},
            {"SHIMMER_FAIL_ERRNO", std::to_string(error)},
            {"SHIMMER_FAIL_LOG", log}};
  }
  void Set() const {
    for (const auto& [name, value] : Variables()) setenv(name.c_str(), value.c_str(), /*overwrite=*/1);
    fail_calls_configure();
  }
};

class FaultyRun {
 public:
  FaultyRun(const fs::path& folder, const Words& words, const Faults& faults = {})
      : calls_(static_cast<long*>(
            mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
        running_(folder, [&] { return Program(words, faults); }) {}
  ~FaultyRun() { munmap(calls_, sizeof(long)); }
  FaultyRun(const FaultyRun&) = delete;

  void Signal(int signal) const { running_.Signal(signal); }
  Ran Wait() { return running_.Wait(); }
  int64_t calls() const { return *calls_; }  // that counted, of a run that has ended by itself

 private:
  int Program(const Words& words, const Faults& faults) const {
    std::vector<const char*> arguments = {"shimmer"};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
    faults.Set();
    const int exit_code = RunShimmer(static_cast<int>(arguments.size()), arguments.data(), Never);
    *calls_ = fail_calls_counted();
    return exit_code;
  }
  static const std::atomic<bool>& Never() {
    static const std::atomic<bool> never{false};
    return never;
  }

  long* calls_;
  Running running_;
};

inline Words GenerateWords(const std::string& config, const std::string& out, const Words& more = {}) {
  Words words = {"generate", config, "--out", out, "--quiet", "--threads", "2"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline Ran RunForked(const TempFolder& folder, const Words& words, const Faults& faults = {}) {
  return FaultyRun(folder.path(), words, faults).Wait();
}

}  // namespace shimmer::app
