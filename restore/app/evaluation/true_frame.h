// What a restored frame is held against: the true one, and which px count.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "restore/app/evaluation/true_clip.h"

namespace shimmer::restore::app {

// Of the steady camera. seen: CV_8UC1, 255 where the frame's camera saw the px itself: the others are filled
// from other frames or from nothing, and count for nobody.
struct TrueFrame {
  std::optional<cv::Mat> clean, moving;  // absent where they are not known; moving: 255, else 0
  cv::Mat seen;

  TrueFrame Inside(cv::Rect area) const;  // what of it lies there
};

// found_px: by which the frame was steadied. Truth that is of the steady camera is taken as it is, so that a
// wrong shift is an error; truth of the frames as they were (others', whose shake is not known) is moved
// along, so that it is none.
TrueFrame TrueFrameOf(TrueClip& clip, int64_t frame, cv::Point2d found_px);

// The turbulent frame moved by the true shake, where it is known: what a perfect stabiliser alone would give.
cv::Mat InputFrameOf(TrueClip& clip, int64_t frame);

}  // namespace shimmer::restore::app
