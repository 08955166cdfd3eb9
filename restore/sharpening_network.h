// A network that sharpens pictures, whatever runs it: our own Restormer, OpenCV's dnn or torch.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace shimmer::restore {

// How large a picture goes through a network at a time. The attention of a Restormer is of the whole picture
// that it sees, so what it makes of a px depends on the tile.
struct TileSize {
  int side_px = 0;
  int overlap_px = 0;  // of neighbouring tiles
  bool fixed = false;  // it takes pictures of side_px alone; else smaller ones too
  friend bool operator==(const TileSize&, const TileSize&) = default;
};

// Throws std::invalid_argument for frames that are smaller than a fixed tile.
void RequireTile(const TileSize& tile, cv::Size frame);

class SharpeningNetwork {
 public:
  virtual ~SharpeningNetwork() = default;
  virtual std::string name() const = 0;
  virtual TileSize tile() const = 0;
  virtual bool TakesManyAtOnce() const { return false; }  // from as many threads
  // CV_32FC3, RGB, 0 is black and 1 is white; the same of what it sees sharpened, which may reach beyond. For
  // one thread at a time, unless it takes many. Throws std::runtime_error where the network gives something
  // else, or not finite.
  virtual cv::Mat Sharpened(const cv::Mat& picture) = 0;
};

}  // namespace shimmer::restore
