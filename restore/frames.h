// A video as restoration reads it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace shimmer::restore {

// Frames 0 .. count() - 1 of one size and type: CV_8U, CV_16U or CV_32F of 1 channel or 3 (RGB). They are
// read in order, more than once. For one thread at a time.
class Frames {
 public:
  virtual ~Frames() = default;
  virtual int64_t count() = 0;
  virtual cv::Mat Read(int64_t frame) = 0;  // not to be written to
};

}  // namespace shimmer::restore
