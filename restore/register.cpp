#include "restore/register.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace shimmer::restore {
namespace {

constexpr int kBand = 64;  // rows that one thread takes at a time

void RequireAtLeastOne(int value, const char* name) {
  if (value < 1)
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + ", must be 1 or more");
}

}  // namespace

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
  if (!params_.scene.grey.empty()) reference_.emplace(params_.scene, params_.flow);
}

void Registration::AddToMean(const GreyFrame& frame) {
  if (sum_.empty()) {
    sum_ = cv::Mat::zeros(frame.grey.size(), CV_32FC1), weight_ = sum_.clone();
    mean_flow_ = cv::Mat::zeros(sum_.size(), CV_32FC2);
  }
  if (frames_ >= params_.memory_frames) {
    const double kept = 1 - 1.0 / params_.memory_frames;
    sum_ *= kept, weight_ *= kept, frames_ *= kept;
  }
  sum_ += frame.grey.mul(frame.weight);
  weight_ += frame.weight;
  ++frames_;
}

void Registration::MakeReference() {
  since_keyframe_ = 0;
  // A px that no frame saw has no value: that of the whole frame.
  cv::Mat mean = sum_ / cv::max(weight_, 1e-6);
  const cv::Mat unseen = weight_ < 1e-3;
  mean.setTo(cv::mean(mean, ~unseen), unseen);
  // Where the old reference's p lies in the new one: flows from there start so much later.
  if (reference_) mean_flow_ -= reference_->To({mean, cv::Mat::ones(mean.size(), CV_32FC1)});
  reference_.emplace(SceneReference{mean, {}}, params_.flow);
}

void Registration::AddToMeanFlow(const cv::Mat& flow, double share) {
  cv::addWeighted(mean_flow_, 1 - share, flow, share, 0, mean_flow_);
}

std::vector<WeighedFrame> Registration::Next(WeighedFrame frame) {
  if (size_.empty()) size_ = frame.frame.size(), type_ = frame.frame.type();
  RequireRegistrable(frame, size_, type_);
  const GreyFrame grey = GreyOf(frame);
  if (!params_.scene.grey.empty()) return {Warped(frame, reference_->To(grey))};
  AddToMean(grey);
  if (!reference_) {
    held_.push_back(std::move(frame));
    return static_cast<int>(held_.size()) < params_.first_frames ? std::vector<WeighedFrame>{} : Rest();
  }
  if (++since_keyframe_ >= params_.frames_a_keyframe) MakeReference();
  const cv::Mat flow = reference_->To(grey);
  flows_ = std::min<double>(flows_ + 1, params_.memory_frames);
  AddToMeanFlow(flow, 1 / flows_);
  return {Warped(frame, flow - mean_flow_)};
}

std::vector<WeighedFrame> Registration::Rest() {
  if (held_.empty()) return {};
  MakeReference();
  std::vector<cv::Mat> flows;
  for (const WeighedFrame& frame : held_) {
    flows.push_back(reference_->To(GreyOf(frame)));
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
