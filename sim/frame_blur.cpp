#include "sim/frame_blur.h"

#include <vector>

#include "sim/exact_blur.h"
#include "sim/rows.h"

namespace shimmer::sim {

FrameBlur::FrameBlur(const Planes& frame, const BlurParams& params, const BlurPlan& plan)
    : level_choice_(params.level_choice), margin_px_(plan.margin_px) {
  if (plan.way == BlurWay::kLadder) {
    ladder_.emplace(frame, LevelLadder::For(params.max_sigma_px, plan.grade));
    return;
  }
  cv::merge(frame, interleaved_);
  if (plan.way == BlurWay::kStack) stack_.emplace(interleaved_, plan.least_sigma_px, params.max_sigma_px);
}

void FrameBlur::Band(cv::Point first, const cv::Mat& sigma_px, Planes& out) const {
  if (ladder_) return ladder_->Band(first, sigma_px, out);
  cv::Mat pixels(1, sigma_px.cols, interleaved_.type());
  for (int y = 0; y < sigma_px.rows; ++y) {
    const cv::Point row = first + cv::Point(0, y);
    if (stack_)
      stack_->Row(row - cv::Point(margin_px_, margin_px_), RowOf(sigma_px, y), level_choice_,
                  pixels.ptr<float>());
    else
      ExactBlurRow(interleaved_, row, RowOf(sigma_px, y), pixels.ptr<float>());
    for (size_t c = 0; c < out.size(); ++c) {
      cv::Mat plane = out[c].row(y);
      cv::extractChannel(pixels, plane, static_cast<int>(c));
    }
  }
}

}  // namespace shimmer::sim
