#include "restore/register.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/detail_level.h"
#include "restore/flow.h"
#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 16;
constexpr int kBand = 64;                  // rows that one thread takes at a time
constexpr double kLeastRange = 1 / 255.0;  // of white: less is not stretched further

void RequireAtLeastOne(int value, const char* name) {
  if (value < 1)
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + ", must be 1 or more");
}

}  // namespace

PairFlow FineFlow() {
  return [flow = std::shared_ptr<DenseFlow>(DisFlow(DisPreset::kMedium))](
             const cv::Mat& from, const cv::Mat& to) { return flow->Flow(from, to); };
}

WeighedFrame Warped(const WeighedFrame& in, const cv::Mat& flow) {
  const cv::Size size = in.frame.size();
  const double per_x = static_cast<double>(size.width) / flow.cols,
               per_y = static_cast<double>(size.height) / flow.rows;
  WeighedFrame out{cv::Mat(size, in.frame.type()), {}};
  if (!in.weight.empty()) out.weight.create(size, CV_8UC1);
  tbb::parallel_for(0, (size.height + kBand - 1) / kBand, [&](int band) {
    const cv::Range rows(band * kBand, std::min((band + 1) * kBand, size.height));
    // Where each px of the band is found: the flow as an enlargement of its centres, and the px itself.
    const cv::Matx23d to_flow(1 / per_x, 0, 0.5 / per_x - 0.5, 0, 1 / per_y,
                              (rows.start + 0.5) / per_y - 0.5);
    cv::Mat map;
    if (flow.size() == size)
      map = flow.rowRange(rows).clone();
    else
      cv::warpAffine(flow, map, to_flow, {size.width, rows.size()}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                     cv::BORDER_REPLICATE);
    for (int y = 0; y < map.rows; ++y) {
      auto* at = map.ptr<cv::Vec2f>(y);
      for (int x = 0; x < map.cols; ++x) {
        at[x][0] = static_cast<float>(x + per_x * static_cast<double>(at[x][0]));
        at[x][1] = static_cast<float>(rows.start + y + per_y * static_cast<double>(at[x][1]));
      }
    }
    cv::Mat to = out.frame.rowRange(rows);
    cv::remap(in.frame, to, map, {}, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    if (in.weight.empty()) return;
    cv::Mat weight = out.weight.rowRange(rows);
    cv::remap(in.weight, weight, map, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  });
  return out;
}

Registration::Registration(RegisterParams params) : params_(std::move(params)) {
  RequireAtLeastOne(params_.first_frames, "first_frames");
  RequireAtLeastOne(params_.frames_a_keyframe, "frames_a_keyframe");
  RequireAtLeastOne(params_.memory_frames, "memory_frames");
  if (!params_.flow) throw std::invalid_argument("flow: there is none");
}

// In levels, CV_32FC1, and its weights in [0, 1]; both reduced.
cv::Mat Registration::GreyOf(const WeighedFrame& frame, cv::Mat& weight) const {
  cv::Mat grey;  // (what is reduced may be the frame itself)
  ReducedGrey(frame.frame, scale_).convertTo(grey, CV_32F, 255 / WhiteOf(frame.frame.depth()));
  if (frame.weight.empty()) {
    weight = cv::Mat::ones(grey.size(), CV_32FC1);
  } else {
    cv::resize(frame.weight({0, 0, grey.cols * scale_, grey.rows * scale_}), weight, grey.size(), 0, 0,
               cv::INTER_AREA);
    weight.convertTo(weight, CV_32F, 1 / 255.0);
  }
  return grey;
}

void Registration::AddToMean(const WeighedFrame& frame) {
  cv::Mat weight;
  const cv::Mat grey = GreyOf(frame, weight);
  if (sum_.empty()) sum_ = cv::Mat::zeros(grey.size(), CV_32FC1), weight_ = sum_.clone();
  if (frames_ >= params_.memory_frames) {
    const double kept = 1 - 1.0 / params_.memory_frames;
    sum_ *= kept, weight_ *= kept, frames_ *= kept;
  }
  sum_ += grey.mul(weight);
  weight_ += weight;
  ++frames_;
}

void Registration::MakeReference() {
  since_keyframe_ = 0;
  // A px that no frame saw has no value: that of the whole frame.
  cv::Mat mean = sum_ / cv::max(weight_, 1e-6);
  const cv::Mat unseen = weight_ < 1e-3;
  mean.setTo(cv::mean(mean, ~unseen), unseen);
  if (reference_.empty()) {
    double white = 0;
    cv::minMaxLoc(mean, &black_, &white);
    gain_ = 255 / std::max(white - black_, 255 * kLeastRange);
    mean_flow_ = cv::Mat::zeros(mean.size(), CV_32FC2);
  }
  cv::Mat reference;
  mean.convertTo(reference, CV_8U, gain_, -gain_ * black_);
  // Where the old reference's p lies in the new one: flows from there start so much later.
  if (!reference_.empty()) mean_flow_ -= params_.flow(reference_, reference);
  reference_ = reference;
}

cv::Mat Registration::FlowOf(const WeighedFrame& frame) const {
  cv::Mat weight, to;
  GreyOf(frame, weight).convertTo(to, CV_8U, gain_, -gain_ * black_);
  if (!frame.weight.empty()) {
    const cv::Mat rest = 1 - weight;
    cv::blendLinear(to, reference_, weight, rest, to);
  }
  return params_.flow(reference_, to);
}

void Registration::AddToMeanFlow(const cv::Mat& flow, double share) {
  cv::addWeighted(mean_flow_, 1 - share, flow, share, 0, mean_flow_);
}

std::vector<WeighedFrame> Registration::Next(WeighedFrame frame) {
  RequireFrame(frame.frame, "frame");
  if (size_.empty()) {
    size_ = frame.frame.size(), type_ = frame.frame.type();
    if (std::min(size_.width, size_.height) < kLeastSide_px)
      throw std::invalid_argument("frame: must be at least 16x16 px");
    scale_ = std::max(size_.width, size_.height) > kLargeSide_px ? 2 : 1;
  }
  if (frame.frame.size() != size_ || frame.frame.type() != type_)
    throw std::invalid_argument("frame: is of another size or type than the first");
  if (!frame.weight.empty() && (frame.weight.type() != CV_8UC1 || frame.weight.size() != size_))
    throw std::invalid_argument("weight: must be CV_8UC1 and of the frame's size");
  AddToMean(frame);
  if (reference_.empty()) {
    held_.push_back(std::move(frame));
    return static_cast<int>(held_.size()) < params_.first_frames ? std::vector<WeighedFrame>{} : Rest();
  }
  if (++since_keyframe_ >= params_.frames_a_keyframe) MakeReference();
  const cv::Mat flow = FlowOf(frame);
  flows_ = std::min<double>(flows_ + 1, params_.memory_frames);
  AddToMeanFlow(flow, 1 / flows_);
  return {Warped(frame, flow - mean_flow_)};
}

std::vector<WeighedFrame> Registration::Rest() {
  if (held_.empty()) return {};
  MakeReference();
  std::vector<cv::Mat> flows;
  for (const WeighedFrame& frame : held_) {
    flows.push_back(FlowOf(frame));
    AddToMeanFlow(flows.back(), 1 / ++flows_);
  }
  std::vector<WeighedFrame> registered;
  for (size_t k = 0; k < held_.size(); ++k) {
    registered.push_back(Warped(held_[k], flows[k] - mean_flow_));
    held_[k] = {};
  }
  held_.clear();
  return registered;
}

}  // namespace shimmer::restore
