#include "restore/scene_reference.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace shimmer::restore {
namespace {

constexpr double kTrustedShare = 0.25;  // of the frames; from it on a px is trusted fully
constexpr double kHidden = 0.01;  // weight of what hides the scene: it is the mean where nothing else is
constexpr double kFade_px = 4;    // of trust

class Mean {
 public:
  // frame: CV_32FC1, weight: in [0, 1].
  void Add(const GreyFrame& frame) {
    if (sum_.empty()) sum_ = cv::Mat::zeros(frame.grey.size(), CV_32FC1), weights_ = sum_.clone();
    const cv::Mat weight = cv::max(frame.weight, kHidden);
    sum_ += frame.grey.mul(weight);
    weights_ += weight;
  }
  cv::Mat Result() const { return sum_ / weights_; }

 private:
  cv::Mat sum_, weights_;
};

// frame: in levels, CV_32FC1.
GreyFrame WithFloatWeight(const WeighedFrame& frame) {
  GreyFrame grey{frame.frame, {}};
  if (frame.weight.empty())
    grey.weight = cv::Mat::ones(grey.grey.size(), CV_32FC1);
  else
    frame.weight.convertTo(grey.weight, CV_32F, 1 / 255.0);
  return grey;
}

}  // namespace

SceneReferenceMean::SceneReferenceMean(PairFlow flow) : flow_(std::move(flow)) {}

void SceneReferenceMean::Add(const WeighedFrame& frame) {
  if (type_ == -1) size_ = frame.frame.size(), type_ = frame.frame.type();
  RequireRegistrable(frame, size_, type_);
  const GreyFrame grey = GreyOf(frame);
  WeighedFrame kept{grey.grey, {}};
  if (!frame.weight.empty()) grey.weight.convertTo(kept.weight, CV_8U, 255);
  frames_.push_back(kept);
}

SceneReference SceneReferenceMean::Result() const {
  if (frames_.empty()) return {};
  Mean plain;
  cv::Mat seen;
  for (const WeighedFrame& kept : frames_) {
    const GreyFrame frame = WithFloatWeight(kept);
    plain.Add(frame);
    if (seen.empty()) seen = cv::Mat::zeros(frame.grey.size(), CV_32FC1);
    seen += frame.weight;
  }
  SceneReference reference{plain.Result(), {}};
  const double enough = kTrustedShare * static_cast<double>(frames_.size());
  cv::GaussianBlur(cv::min(seen / enough, 1.0), reference.trust, {0, 0}, kFade_px, 0, cv::BORDER_REPLICATE);

  const ReferenceFlow flow(reference, flow_);
  Mean registered;
  for (const WeighedFrame& kept : frames_) {
    const GreyFrame frame = WithFloatWeight(kept);
    registered.Add(WithFloatWeight(Warped({frame.grey, kept.weight}, flow.To(frame))));
  }
  reference.grey = registered.Result();
  return reference;
}

}  // namespace shimmer::restore
