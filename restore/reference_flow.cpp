#include "restore/reference_flow.h"

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "restore/detail_level.h"
#include "restore/flow.h"
#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 16;
constexpr double kLeastRange = 1 / 255.0;  // of white: less is not stretched further
constexpr double kParts = 256;             // of a level, that grey is rounded to
// The light's grid. Smoother than what turbulence does, so that it is not taken for light.
constexpr int kLightCell_px = 16;
constexpr double kLightCells = 3;  // standard deviation of its blur
constexpr double kFaint = 1;       // levels: black needs no light

// How much brighter the scene is than the frame, px by px but smoothly: light that drifts, or a cloud, must
// not be taken for motion.
cv::Mat LightOf(const cv::Mat& scene, const cv::Mat& frame, const cv::Mat& weight) {
  const cv::Size cells(std::max(1, frame.cols / kLightCell_px), std::max(1, frame.rows / kLightCell_px));
  const auto smooth = [&](const cv::Mat& grey) {
    cv::Mat mean;
    cv::resize(grey.mul(weight), mean, cells, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(mean, mean, {0, 0}, kLightCells, 0, cv::BORDER_REPLICATE);
    return cv::Mat(cv::max(mean, 0.0) + kFaint);
  };
  cv::Mat light = smooth(scene) / smooth(frame);
  cv::resize(light, light, frame.size(), 0, 0, cv::INTER_LINEAR);
  return light;
}

}  // namespace

PairFlow FineFlow() {
  return [flow = std::shared_ptr<DenseFlow>(DisFlow(DisPreset::kMedium))](
             const cv::Mat& from, const cv::Mat& to) { return flow->Flow(from, to); };
}

void RequireRegistrable(const WeighedFrame& frame, cv::Size size, int type) {
  RequireFrame(frame.frame, "frame");
  if (std::min(frame.frame.cols, frame.frame.rows) < kLeastSide_px)
    throw std::invalid_argument("frame: must be at least 16x16 px");
  if (frame.frame.size() != size || frame.frame.type() != type)
    throw std::invalid_argument("frame: is of another size or type than the first");
  if (!frame.weight.empty() && (frame.weight.type() != CV_8UC1 || frame.weight.size() != size))
    throw std::invalid_argument("weight: must be CV_8UC1 and of the frame's size");
}

GreyFrame GreyOf(const WeighedFrame& frame) {
  const int scale = std::max(frame.frame.cols, frame.frame.rows) > kLargeSide_px ? 2 : 1;
  cv::Mat parts;
  ReducedGrey(frame.frame, scale).convertTo(parts, CV_16U, 255 * kParts / WhiteOf(frame.frame.depth()));
  GreyFrame grey;
  parts.convertTo(grey.grey, CV_32F, 1 / kParts);
  const cv::Size size = grey.grey.size();
  if (frame.weight.empty()) {
    grey.weight = cv::Mat::ones(size, CV_32FC1);
  } else {
    cv::resize(frame.weight({0, 0, size.width * scale, size.height * scale}), grey.weight, size, 0, 0,
               cv::INTER_AREA);
    grey.weight.convertTo(grey.weight, CV_32F, 1 / 255.0);
  }
  return grey;
}

ReferenceFlow::ReferenceFlow(SceneReference reference, PairFlow flow)
    : reference_(std::move(reference)), flow_(std::move(flow)) {
  double white = 0;
  cv::minMaxLoc(reference_.grey, &black_, &white);
  gain_ = 255 / std::max(white - black_, 255 * kLeastRange);
  bytes_ = Bytes(reference_.grey);
}

cv::Mat ReferenceFlow::Bytes(const cv::Mat& grey) const {
  cv::Mat bytes;
  grey.convertTo(bytes, CV_8U, gain_, -gain_ * black_);
  return bytes;
}

cv::Mat ReferenceFlow::To(const GreyFrame& frame) const {
  if (frame.grey.size() != bytes_.size())
    throw std::invalid_argument("frame: is of another size than the reference");
  const cv::Mat weight = reference_.trust.empty() ? frame.weight : frame.weight.mul(reference_.trust);
  const cv::Mat rest = 1 - weight;
  cv::Mat to = Bytes(frame.grey.mul(LightOf(reference_.grey, frame.grey, weight)));
  cv::blendLinear(to, bytes_, weight, rest, to);
  cv::Mat flow = flow_(bytes_, to);
  if (reference_.trust.empty()) return flow;
  cv::Mat trust;
  cv::merge(std::vector<cv::Mat>(2, reference_.trust), trust);
  return flow.mul(trust);
}

}  // namespace shimmer::restore
