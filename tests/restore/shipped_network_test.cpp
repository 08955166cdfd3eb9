// The weights that unshimmer carries.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "restore/open_network.h"
#include "restore/sharpen.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

double Rms(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L2) /
         std::sqrt(static_cast<double>(a.total() * static_cast<size_t>(a.channels())));
}

// A still scene as it leaves stacking: the running mean of nine frames of a tilt of 1 px, in 8 bits.
std::vector<cv::Mat> Stacked(int frames, cv::Size size) {
  constexpr int kWindow = 9;
  std::vector<cv::Mat> seen, stacked;
  for (int k = 0; k < frames + kWindow; ++k)
    seen.push_back(SeenFrame({.size = size, .tilt_rms_px = 1, .frame = static_cast<uint32_t>(k)}));
  for (int k = 0; k < frames; ++k) {
    cv::Mat sum = cv::Mat::zeros(size, CV_32FC1);
    for (int i = 0; i < kWindow; ++i) sum += seen[static_cast<size_t>(k + i)];
    sum.convertTo(stacked.emplace_back(), CV_8U, 255.0 / kWindow);
  }
  return stacked;
}

// Within half a level, RMS.
TEST(ShippedNetwork, KeptTilesAreAsGoodAsNew) {
  const cv::Size size{200, 150};
  Sharpener keeping(ShippedNetwork(), size),
      anew(ShippedNetwork(), size, {.kept_levels = 0, .kept_local_levels = 0});
  for (const cv::Mat& frame : Stacked(12, size)) EXPECT_LE(Rms(keeping.Next(frame), anew.Next(frame)), 0.5);
  EXPECT_EQ(anew.counts().kept, 0);
}

TEST(ShippedNetwork, IsSmall) {
  const std::filesystem::path file =
      std::filesystem::path(SHIMMER_SOURCE_DIR) / "restore/models/shimmer.safetensors";
  EXPECT_LE(std::filesystem::file_size(file), 4'000'000u);
  EXPECT_EQ(OpenNetwork(file)->name(), ShippedNetwork()->name());
}

}  // namespace
}  // namespace shimmer::restore
