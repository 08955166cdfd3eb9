// Truth of moving scenes, drawn over pictures of them: where objects are, and how the camera shakes.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shimmer::app {

// The line of an outline lies on the outermost covered pixels, its shadow on those around them: one of the
// two is seen on any background.
inline const cv::Vec3b kOutline(0, 255, 60), kOutlineShadow(0, 40, 10);
inline const cv::Vec3b kShakePath(255, 255, 255), kShakePlace(255, 190, 0);

// Of one frame. What is not known is empty, and not drawn.
struct SceneMarks {
  cv::Mat mask = {};  // CV_32FC1: coverage in the steady frame
  std::optional<cv::Point2d> clean_shake_px = {},
                             turb_shake_px = {};  // how far what is seen lies off the steady frame
  std::vector<cv::Point2d> path_px = {};          // shake of every frame of the clip
  size_t place = 0;                               // of this frame in it

  bool HasPath() const;       // one that is not all zero
  std::string Label() const;  // "shake up to 5.3 px"; empty where there is no path
};

// Draws on CV_8UC3 RGB pictures of the frame, of the size that they are shown in; shifts are in px of the
// frame. Where the frame ends there is no line. Throws std::invalid_argument for other types.
void DrawOutline(cv::Mat& shown, const cv::Mat& mask, cv::Point2d shake_px);

// The camera's path in the picture's upper right corner: its first place is in the middle, the furthest one
// at the rim of the inset, this frame's is a dot. On a picture that is too small for it nothing is drawn.
void DrawShakeInset(cv::Mat& shown, std::span<const cv::Point2d> path_px, size_t place);
cv::Rect ShakeInsetArea(cv::Size shown);  // empty where it is too small

void MarkClean(cv::Mat& shown, const SceneMarks& marks);
void MarkTurb(cv::Mat& shown, const SceneMarks& marks);

}  // namespace shimmer::app
