// The programs as people call them, `shimmer` unless told otherwise: started with arguments, seen by the exit
// code and what they print.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"
#include "tests/dataset/small_set.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::app {

namespace fs = std::filesystem;
using dataset::TempFolder;
using dataset::Tree;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

struct Ran {
  int exit_code;  // 128 + signal where one ended it
  std::string out, err;
  int64_t peak_bytes = 0;  // the most memory that it had at a time
};

inline constexpr int kNotStarted = 127;

// A process that has been started, in a working directory of its own.
class Running {
 public:
  // The program; as_nobody: by a user who owns nothing.
  Running(const fs::path& folder, const Words& words, bool as_nobody = false,
          const char* program = SHIMMER_PROGRAM)
      : Running(folder, [&] {
          Words named = words;
          named.insert(named.begin(), program);
          std::vector<char*> arguments;
          for (std::string& word : named) arguments.push_back(word.data());
          arguments.push_back(nullptr);
          constexpr uid_t kNobody = 65534;
          if (!as_nobody || setuid(kNobody) == 0) execv(program, arguments.data());
          return kNotStarted;
        }) {}

  // A copy of this process, which ends with what body returns.
  Running(const fs::path& folder, const std::function<int()>& body)
      : out_(std::tmpfile()), err_(std::tmpfile()) {
    std::fflush(nullptr);  // or else the copy would print what waits here once more
    pid_ = fork();
    if (pid_ != 0) return;
    dup2(fileno(out_), STDOUT_FILENO);
    dup2(fileno(err_), STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(kNotStarted);
    const int exit_code = body();
    std::fflush(nullptr);
    _exit(exit_code);
  }
  ~Running() {
    std::fclose(out_);
    std::fclose(err_);
  }
  Running(const Running&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const { kill(pid_, signal); }

  Ran Wait() {
    int status = 0;
    rusage used = {};
    wait4(pid_, &status, 0, &used);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), Text(out_), Text(err_),
            int64_t{used.ru_maxrss} * 1024};
  }

 private:
  static std::string Text(FILE* file) {
    std::rewind(file);
    std::string text;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
    return text;
  }

  FILE *out_, *err_;
  pid_t pid_;
};

// Looks every millisecond, for a minute at most.
template <class Condition>
void WaitUntil(const Condition& condition) {
  for (int i = 0; i < 60'000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

inline Ran Shimmer(const fs::path& folder, const Words& words) { return Running(folder, words).Wait(); }
inline Ran Shimmer(const TempFolder& folder, const Words& words) { return Shimmer(folder.path(), words); }

// shimmer generate CONFIG --out OUT --quiet MORE
inline Ran Generate(const TempFolder& folder, const std::string& config, const std::string& out,
                    const Words& more = {}) {
  Words words = {"generate", config, "--out", out, "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return Shimmer(folder, words);
}

// The program gave this exit code, printed nothing but one line, and the line says all of this.
inline void ExpectOneLine(const Ran& ran, int exit_code, const Words& parts,
                          const std::string& program = "shimmer") {
  EXPECT_EQ(ran.exit_code, exit_code) << ran.err;
  EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
  EXPECT_TRUE(ran.err.starts_with(program + ": ") && ran.err.ends_with("\n")) << ran.err;
  for (const std::string& part : parts) EXPECT_THAT(ran.err, testing::HasSubstr(part));
  EXPECT_EQ(ran.out, "");
}

inline void ExpectDone(const Ran& ran) {
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
}

// A config of small drawn clips, with each of the given sections or keys added or replaced.
inline std::string SmallConfig(const Json& changes = Json::object()) {
  Json config = {{"seed", 0},
                 {"clips", 4},
                 {"frames", 2},
                 {"size", {24, 16}},
                 {"source", {{"drawn", "chart"}}},
                 {"blur", {{"max_sigma_px", 1}}}};
  config.update(changes);
  return config.dump();
}

inline void WritePng(const TempFolder& folder, const std::string& name, const cv::Mat& image, int bits = 8) {
  folder.Put(name, dataset::EncodePng(image, bits));
}

// By OpenImageIO itself, with samples of a type: what our own writers never make. The format is the name's.
inline void PutWithOiio(const TempFolder& folder, const std::string& name, const cv::Mat& image,
                        OIIO::TypeDesc type) {
  const fs::path path = folder / name;
  fs::create_directories(path.parent_path());
  const auto output = OIIO::ImageOutput::create(path.string());
  EXPECT_TRUE(output && output->open(path.string(), {image.cols, image.rows, image.channels(), type}) &&
              output->write_image(OIIO::TypeFloat, image.data) && output->close())
      << OIIO::geterror();
}

inline std::string ReadText(const fs::path& path) {
  const auto bytes = dataset::ReadFile(path);
  return {bytes.begin(), bytes.end()};
}

// Lines of a manifest, in their order.
inline std::vector<Json> ManifestLines(const fs::path& data_set) {
  std::vector<Json> lines;
  std::ifstream file(data_set / "manifest.jsonl");
  for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
  return lines;
}

// What lies in a folder, hidden files too.
inline std::set<std::string> NamesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

}  // namespace shimmer::app
