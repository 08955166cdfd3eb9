// The frames of a video sharpened by a network, in tiles, of which those are left out that need nothing new.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

struct SharpenParams {
  // A tile keeps what was added to it (not its px, which are the frame's own) while its px are within this of
  // those that it was made of, RMS in levels of [0, 255], on top of what rounding to 8 or 16 bits makes of
  // equal pictures; and within kept_local_levels in each block of 16x16 px, so that a small thing leaves no
  // trace. 0: only while they are the same.
  double kept_levels = 0.5;
  double kept_local_levels = 1.5;
  double flat_levels = 0.25;  // a tile whose standard deviation is no more passes as it is
};

// What became of the tiles of the frames so far.
struct SharpenCounts {
  int64_t computed = 0, kept = 0, flat = 0;
  friend bool operator==(const SharpenCounts&, const SharpenCounts&) = default;
};

class Sharpener {
 public:
  // Throws as RequireTile does.
  Sharpener(std::shared_ptr<SharpeningNetwork> network, cv::Size frame, const SharpenParams& params = {});

  // A frame sharpened: of its size and type (levels.h). The three channels that a network makes of grey are
  // averaged. Floats beyond black and white are moved as far as those are; what is no number is black to the
  // network, and stays none. Throws std::invalid_argument for a frame of another size, and what the network
  // throws.
  cv::Mat Next(const cv::Mat& frame);
  const SharpenCounts& counts() const { return counts_; }  // as long as Next has thrown nothing

 private:
  struct Tile {
    cv::Rect place;
    cv::Mat from, made;  // CV_32FC3 in [0, 1]; what was added to it. Empty: nothing was made yet
  };

  enum class Renewal { kKept, kFlat, kComputed };
  // Computes what is added to a tile, unless it can be kept. For several tiles at a time.
  Renewal Renew(Tile& tile, const cv::Mat& picture, double rounding) const;

  std::shared_ptr<SharpeningNetwork> network_;
  cv::Size size_;
  SharpenParams params_;
  std::vector<Tile> tiles_;
  cv::Mat change_;  // of the whole frame, as of the last that was not kept
  SharpenCounts counts_;
};

}  // namespace shimmer::restore
