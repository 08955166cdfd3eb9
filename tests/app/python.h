// Debian's Python as a second opinion, where it is installed.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace shimmer::app {

inline constexpr const char* kPython = "/usr/bin/python3";

inline bool PythonHas(const std::string& module) {
  return std::system((std::string(kPython) + " -c 'import " + module + "' >/dev/null 2>&1").c_str()) == 0;
}

// What the script prints. Its arguments, sys.argv[1:], are the paths of files that hold the given texts.
inline std::string RunPython(const std::string& script, const std::vector<std::string>& texts) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("shimmer_python_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::string command = std::string(kPython) + " '" + (folder / "script.py").string() + "'";
  std::ofstream(folder / "script.py") << script;
  for (size_t i = 0; i < texts.size(); ++i) {
    const fs::path file = folder / (std::to_string(i) + ".json");
    std::ofstream(file) << texts[i];
    command += " '" + file.string() + "'";
  }
  std::string printed;
  if (FILE* pipe = popen((command + " 2>&1").c_str(), "r")) {
    for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) printed += static_cast<char>(c);
    EXPECT_EQ(pclose(pipe), 0) << printed;
  } else {
    ADD_FAILURE() << command;
  }
  fs::remove_all(folder);
  return printed;
}

}  // namespace shimmer::app
