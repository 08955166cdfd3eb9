#include "restore/app/evaluation/true_frame.h"

#include "restore/translate.h"

namespace shimmer::restore::app {
namespace {

cv::Rect WithoutMargin(cv::Size size, int margin_px) {
  return cv::Rect(margin_px, margin_px, std::max(size.width - 2 * margin_px, 0),
                  std::max(size.height - 2 * margin_px, 0));
}

}  // namespace

TrueFrame TrueFrame::Inside(cv::Rect area) const {
  TrueFrame inside{.clean = {}, .moving = {}, .seen = seen(area)};
  if (clean) inside.clean = (*clean)(area);
  if (moving) inside.moving = (*moving)(area);
  return inside;
}

TrueFrame TrueFrameOf(TrueClip& clip, int64_t frame, cv::Point2d found_px) {
  const cv::Size size = clip.facts().size;
  const std::optional<cv::Point2d> shake_px = clip.Shake(frame);
  TrueFrame truth{
      .clean = clip.Clean(frame), .moving = clip.Mask(frame), .seen = cv::Mat::zeros(size, CV_8UC1)};
  if (!shake_px && truth.clean) truth.clean = Translated(*truth.clean, found_px);
  if (!shake_px && truth.moving) truth.moving = Translated(*truth.moving, found_px) >= 128;
  const cv::Rect seen = SeenArea(size, shake_px.value_or(found_px));
  truth.seen(seen & WithoutMargin(size, clip.margin_px())).setTo(255);
  return truth;
}

cv::Mat InputFrameOf(TrueClip& clip, int64_t frame) {
  return Translated(clip.Turb(frame), clip.Shake(frame).value_or(cv::Point2d()));
}

}  // namespace shimmer::restore::app
