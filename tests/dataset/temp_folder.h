// What the tests of this room share: a folder of their own, pictures of known pixels, texts of errors.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/dataset/files.h"

namespace shimmer::dataset {

// A new empty folder, gone with its content at the end.
class TempFolder {
 public:
  TempFolder() {
    // In memory where there is such a place: every file is synced, which on a busy disk takes its time.
    for (const std::filesystem::path& place :
         {std::filesystem::path("/dev/shm"), std::filesystem::temp_directory_path()}) {
      std::string name = (place / "shimmer_test_XXXXXX").string();
      if (!mkdtemp(name.data())) continue;
      path_ = name;
      return;
    }
    throw std::runtime_error("no temporary folder");
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  // Writes a file, with the folders above it.
  std::filesystem::path Put(const std::string& name, std::span<const uint8_t> bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    WriteFile(path_ / name, bytes);
    return path_ / name;
  }
  std::filesystem::path Put(const std::string& name, const std::string& text) const {
    return Put(name, AsBytes(text));
  }

 private:
  std::filesystem::path path_;
};

// Float pixels that are no multiple of any step: uniform in [low, high].
inline cv::Mat RandomImage(cv::Size size, int channels, uint32_t seed, float low = 0, float high = 1) {
  cv::Mat image(size, CV_MAKETYPE(CV_32F, channels));
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> value(low, high);
  for (int y = 0; y < image.rows; ++y)
    for (int i = 0; i < image.cols * channels; ++i) image.ptr<float>(y)[i] = value(generator);
  return image;
}

// Same size, type and bits.
inline bool SameBits(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  for (int y = 0; y < a.rows; ++y)
    if (std::memcmp(a.ptr(y), b.ptr(y), a.cols * a.elemSize()) != 0) return false;
  return true;
}

// What the call throws: its text, or "" if nothing.
template <class Error, class Call>
std::string ErrorOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace shimmer::dataset
