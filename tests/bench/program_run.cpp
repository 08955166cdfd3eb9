#include "tests/bench/program_run.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace shimmer::bench {
namespace {

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProgramRun RunProgram(const std::vector<std::string>& words, const std::function<void(double)>& watch) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error(words[0] + ": can't be started");
  if (process == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(words[0].c_str(), arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage usage = {};
  while (wait4(process, &status, WNOHANG, &usage) == 0) {
    watch(seconds());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(words[0] + ": failed");
  return {.wall_s = seconds(),
          .cpu_s = Seconds(usage.ru_utime) + Seconds(usage.ru_stime),
          .peak_MB = static_cast<double>(usage.ru_maxrss) * 1024 / 1e6};
}

int64_t LineCounter::Now() {
  std::ifstream stream(file_, std::ios::binary);
  stream.seekg(bytes_);
  std::array<char, 1 << 16> part;
  while (stream.read(part.data(), part.size()), stream.gcount() > 0) {
    bytes_ += stream.gcount();
    lines_ += std::count(part.data(), part.data() + stream.gcount(), '\n');
  }
  return lines_;
}

}  // namespace shimmer::bench
