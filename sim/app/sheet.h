// Pictures for people: a contact sheet of frames beside their truth, and the frames of an animation.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>

#include "sim/app/scene_marks.h"

namespace shimmer::app {

// Frames are CV_32FC1 or CV_32FC3 (RGB) in [0, 1]; what lies outside is clipped, NaN shows black. Any of them
// may be empty, and is shown as absent. Labels are ASCII.
struct SheetRow {
  std::string label;  // "clip 3 frame 8   S 5.2 px   f 0.031"
  cv::Mat clean, turb;
  cv::Mat tilt;                          // CV_32FC2: dx, dy in px
  cv::Mat sigma;                         // CV_32FC1, px
  std::optional<SceneMarks> marks = {};  // drawn over clean and turb
};

// One row of cells a SheetRow, under titles and, for tilt and sigma, one scale for the whole sheet: tilt's
// colours are full from twice its RMS, or its longest if that is less. An image's longest side is brought
// down to cell_px >= 16, or up by whole factors as far as it fits. Gives CV_8UC3 RGB. Throws
// std::invalid_argument for other types or a smaller cell_px.
cv::Mat DrawSheet(std::span<const SheetRow> rows, int cell_px = 256);

// Clean and turbulent frame side by side. Frames of equal size give pictures of equal size, whatever the
// labels (a long one is cut). Gives CV_8UC3 RGB; types as above.
cv::Mat DrawClipFrame(const cv::Mat& clean, const cv::Mat& turb, const std::string& label,
                      const std::optional<SceneMarks>& marks = {});

}  // namespace shimmer::app
