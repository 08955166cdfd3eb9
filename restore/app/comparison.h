// Two sequences measured frame by frame: each read once, in order, and a few frames of them kept at a time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "restore/app/evaluation/measures.h"
#include "restore/rolling.h"
#include "restore/stability.h"
#include "sim/dataset/frame_reader.h"

namespace shimmer::restore::app {

struct FrameScores {
  Value psnr_db, ssim_opencv, ssim_scikit_image, psnr_y_db, ssim_y;  // of A against B
  Value iou, precision, recall;                                      // likewise, instead, of masks
  std::array<Value, 2> line_deviation_deg;                           // of A, of B
  std::array<Value, 2> difference_levels;                            // to the frame before, likewise
};

// A score of A against B: the more, the better.
struct Score {
  const char *name, *label;  // in JSON, in the table
  int decimals;
  Value FrameScores::*value;
};
inline constexpr Score kPictureScores[] = {
    {"psnr_db", "PSNR, dB", 2, &FrameScores::psnr_db},
    {"ssim_opencv", "SSIM (OpenCV)", 4, &FrameScores::ssim_opencv},
    {"ssim_scikit_image", "SSIM (scikit-image)", 4, &FrameScores::ssim_scikit_image},
    {"psnr_y_db", "PSNR-Y, dB", 2, &FrameScores::psnr_y_db},
    {"ssim_y", "SSIM-Y", 4, &FrameScores::ssim_y}};
inline constexpr Score kMaskScores[] = {{"iou", "IoU", 4, &FrameScores::iou},
                                        {"precision", "precision", 4, &FrameScores::precision},
                                        {"recall", "recall", 4, &FrameScores::recall}};

// What is compared. The names stand in errors.
struct Compared {
  std::string name;
  dataset::FrameReader& frames;
};

struct ComparisonTask {
  Compared a, b;
  bool are_masks = false;        // A and B are: only how they meet is measured
  std::optional<Compared> mask;  // what moves is white
  bool slices = false;           // of one row over time, wanted
  std::optional<int> slice_row;  // absent: the middle
  int threads = 0;               // 0: all
};

struct Comparison {
  cv::Size size;
  bool are_masks = false;
  bool b_is_still = false;  // its line deviation is in the first frame alone, its difference in none
  std::vector<FrameScores> frames;
  std::array<cv::Mat, 2> slices;  // of A and B, empty where not wanted

  std::span<const Score> scores() const {
    return are_masks ? std::span<const Score>(kMaskScores) : kPictureScores;
  }
};

// Frames are measured on several threads; the result is the same on any number of them. step: called after
// each frame. B and the mask have as many frames as A, or one that counts for all. Throws
// std::invalid_argument for other counts and sizes, std::runtime_error for a file that can't be read,
// dataset::Interrupted once stop is set.
Comparison CompareSequences(const ComparisonTask& task, const std::atomic<bool>& stop,
                            const std::function<void()>& step);

}  // namespace shimmer::restore::app
