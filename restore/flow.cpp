#include "restore/flow.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <stdexcept>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 64;  // for its pyramid; smaller frames get their edges continued

// Of kMedium's last refinement: the weights of smoothness and of equal brightness, OpenCV's being 20 and 5.
// Turbulence is finer than the motion that these are for.
constexpr float kRefinedAlpha = 10, kRefinedDelta = 10;

cv::Mat Grey(const cv::Mat& frame) {
  cv::Mat grey = frame;
  if (frame.channels() == 3) cv::cvtColor(frame, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

class Dis : public DenseFlow {
 public:
  explicit Dis(DisPreset preset)
      : dis_(cv::DISOpticalFlow::create(preset == DisPreset::kFast ? cv::DISOpticalFlow::PRESET_FAST
                                                                   : cv::DISOpticalFlow::PRESET_MEDIUM)) {
    if (preset == DisPreset::kFast) return;
    dis_->setVariationalRefinementAlpha(kRefinedAlpha);
    dis_->setVariationalRefinementDelta(kRefinedDelta);
  }

 private:
  cv::Mat Compute(const cv::Mat& from, const cv::Mat& to) override {
    cv::Mat flow;
    dis_->calc(Grey(from), Grey(to), flow);
    return flow;
  }

  cv::Ptr<cv::DISOpticalFlow> dis_;
};

// With the numbers of OpenCV's own example.
class Farneback : public DenseFlow {
 private:
  cv::Mat Compute(const cv::Mat& from, const cv::Mat& to) override {
    cv::Mat flow;
    cv::calcOpticalFlowFarneback(Grey(from), Grey(to), flow, 0.5, 3, 15, 3, 5, 1.2, 0);
    return flow;
  }
};

cv::Mat Bytes(const cv::Mat& frame) {
  const cv::Mat small = HalvedIfLarge(frame);
  cv::Mat bytes;
  small.convertTo(bytes, CV_8U, 255 / WhiteOf(frame.depth()));
  const int right = std::max(0, kLeastSide_px - bytes.cols), below = std::max(0, kLeastSide_px - bytes.rows);
  if (right > 0 || below > 0)
    cv::copyMakeBorder(bytes, bytes, 0, below, 0, right, cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  return bytes;
}

// Of what was computed for frames of that size, as Bytes has them.
cv::Mat AtSize(const cv::Mat& computed, const cv::Mat& frame) {
  const cv::Size small = HalvedIfLarge(frame).size();
  cv::Mat flow = computed(cv::Rect({0, 0}, small));
  if (small == frame.size()) return flow;
  // (an odd last row or column is not of the halves: it continues them)
  cv::Mat large, result;
  cv::resize(flow, large, small * 2, 0, 0, cv::INTER_LINEAR);
  cv::copyMakeBorder(large * 2, result, 0, frame.rows - large.rows, 0, frame.cols - large.cols,
                     cv::BORDER_REPLICATE);
  return result;
}

}  // namespace

cv::Mat DenseFlow::Flow(const cv::Mat& from, const cv::Mat& to) { return Flows(from, {to})[0]; }

std::vector<cv::Mat> DenseFlow::Flows(const cv::Mat& from, const std::vector<cv::Mat>& to) {
  RequireFrame(from, "from");
  std::vector<cv::Mat> bytes;
  for (const cv::Mat& frame : to) {
    RequireFrame(frame, "to");
    if (from.size() != frame.size() || from.channels() != frame.channels())
      throw std::invalid_argument("flow: frames are of two sizes or numbers of channels");
    bytes.push_back(Bytes(frame));
  }
  std::vector<cv::Mat> flows = ComputeAll(Bytes(from), bytes);
  for (cv::Mat& flow : flows) flow = AtSize(flow, from);
  return flows;
}

std::unique_ptr<DenseFlow> DisFlow(DisPreset preset) { return std::make_unique<Dis>(preset); }

FlowMaker DisFlows() {
  return [] { return DisFlow(); };
}

FlowMaker FarnebackFlows() {
  return [] { return std::make_unique<Farneback>(); };
}

cv::Mat HalvedIfLarge(const cv::Mat& frame) {
  if (std::max(frame.cols, frame.rows) <= kLargeSide_px || std::min(frame.cols, frame.rows) < 2) return frame;
  const cv::Size half(frame.cols / 2, frame.rows / 2);
  cv::Mat small;
  cv::resize(frame({{0, 0}, half * 2}), small, half, 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace shimmer::restore
