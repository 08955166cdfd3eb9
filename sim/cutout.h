// A picture with alpha as an object: placed anywhere, scaled and turned.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "sim/layer.h"
#include "sim/motion.h"

namespace shimmer::sim {

class Cutout {
 public:
  // rgba: CV_32FC4, colours times alpha, in [0, 1]. Beyond its edges it is transparent. Throws
  // std::invalid_argument for another type, or an empty picture.
  explicit Cutout(const cv::Mat& rgba);

  // Its height is height_px times the pose's scale. Catmull-Rom between the samples of the picture, or of one
  // made smaller by halves (the means of four samples) such that no sample is left out; the alpha of the
  // result is in [0, 1], and colours are within it. An unscaled, unturned picture at a whole place is copied.
  // Of it what lies within an area; empty if there is nothing, as for a height of 0.
  Layer Draw(double height_px, const Pose& pose, cv::Rect within = kEverywhere) const;

  int64_t bytes() const;  // that it takes

 private:
  std::vector<cv::Mat> halved_;  // each half of the one before; with a transparent border
};

}  // namespace shimmer::sim
