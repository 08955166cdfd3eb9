#include "restore/background.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/levels.h"
#include "restore/luck.h"
#include "restore/window_mean.h"

namespace shimmer::restore {
namespace {

constexpr int kMostAhead = 14;
constexpr double kFullWindow_px = 0.3;  // tilt from which on it is the longest
constexpr double kLeastRegistered_px = 0.25;
constexpr int kFilledShare = 4;  // a filled px counts that many times less
constexpr int kNearMoving_px = 12;

int PiecesOf(int cols) { return (cols + kPiece_px - 1) / kPiece_px; }

// 255 - moving, less where the frame is filled. Empty if it is 255 everywhere.
cv::Mat WeightOf(const cv::Mat& own, const cv::Mat& moving, cv::Size size) {
  if ((!own.empty() && (own.type() != CV_8UC1 || own.size() != size)) ||
      (!moving.empty() && (moving.type() != CV_8UC1 || moving.size() != size)))
    throw std::invalid_argument("own, moving: must be CV_8UC1 and of the frame's size");
  const bool all_own = own.empty() || cv::countNonZero(own) == static_cast<int>(own.total());
  if (all_own && (moving.empty() || cv::countNonZero(moving) == 0)) return {};
  cv::Mat weight = moving.empty() ? cv::Mat(size, CV_8UC1, cv::Scalar(255)) : cv::Mat(255 - moving);
  if (!all_own) cv::Mat(weight / kFilledShare).copyTo(weight, own == 0);
  return weight;
}

// The luck of a frame, but for what is near something that moves, whose edges are not the scene's: it is as
// unlucky as can be, and counts where there is nothing else.
cv::Mat LuckBeside(const WeighedFrame& frame) {
  cv::Mat luck = LuckOf(frame.frame);
  if (frame.weight.empty()) return luck;
  const cv::Mat square =
      cv::getStructuringElement(cv::MORPH_RECT, {2 * kNearMoving_px + 1, 2 * kNearMoving_px + 1});
  cv::Mat near_moving;
  cv::erode(frame.weight, near_moving, square);
  luck.setTo(0, near_moving < 255);
  return luck;
}

}  // namespace

BackgroundParams BackgroundFor(const TurbulenceStrength& strength, Register registered) {
  const double tilt_px = std::sqrt(std::max(0.0, strength.tilt_variance_px2));
  BackgroundParams params;
  params.ahead = static_cast<int>(std::lround(kMostAhead * std::min(1.0, tilt_px / kFullWindow_px)));
  params.registered =
      registered == Register::kOn || (registered == Register::kAuto && tilt_px >= kLeastRegistered_px);
  return params;
}

Background::Background(BackgroundParams params) : params_(std::move(params)) {
  if (params_.ahead < 0 || params_.ahead > 100)
    throw std::invalid_argument("ahead = " + std::to_string(params_.ahead) + ", must be in [0, 100]");
  for (int k = 0; k <= 2 * params_.ahead; ++k)
    gaussian_.push_back(
        static_cast<float>(std::exp(-0.5 * std::pow(k / std::max<double>(params_.ahead, 1), 2))));
  if (params_.registered)
    registration_.emplace(RegisterParams{.scene = params_.scene,
                                         .first_frames = params_.ahead + 1,
                                         .frames_a_keyframe = params_.ahead + 1,
                                         .flow = params_.flow});
}

void Background::StartFrom(const cv::Mat& background) {
  RequireFrame(background, "background");
  if (type_ != -1) throw std::invalid_argument("background: must be there before the first frame");
  size_ = background.size(), type_ = background.type();
  before_ = {background, cv::Mat(size_, CV_8UC1, cv::Scalar(255))};
}

std::vector<BackgroundFrame> Background::Next(const SteadyFrame& steady, const cv::Mat& moving) {
  RequireFrame(steady.frame, "frame");
  if (type_ == -1) size_ = steady.frame.size(), type_ = steady.frame.type();
  if (steady.frame.size() != size_ || steady.frame.type() != type_)
    throw std::invalid_argument("frame: is of another size or type than the first");
  WeighedFrame frame{steady.frame, WeightOf(steady.own, moving, size_)};
  std::vector<BackgroundFrame> known;
  if (registration_) {
    for (WeighedFrame& registered : registration_->Next(std::move(frame))) Add(std::move(registered), known);
  } else {
    Add(std::move(frame), known);
  }
  return known;
}

std::optional<BackgroundFrame> Background::Rest() {
  std::vector<BackgroundFrame> none;  // what registering holds back does not fill the window
  if (registration_)
    for (WeighedFrame& registered : registration_->Rest()) Add(std::move(registered), none);
  if (at_ >= window_.size()) return {};
  return Given();
}

void Background::Add(WeighedFrame frame, std::vector<BackgroundFrame>& known) {
  Waiting waiting{std::move(frame), {}, {}};
  if (params_.lucky) waiting.luck = LuckBeside(waiting.seen);
  if (const cv::Mat& weight = waiting.seen.weight; !weight.empty())
    for (int y = 0; y < weight.rows; ++y)
      for (int piece = 0; piece < PiecesOf(weight.cols); ++piece) {
        const auto* row = weight.ptr<uint8_t>(y);
        waiting.full.push_back(std::all_of(row + piece * kPiece_px,
                                           row + std::min((piece + 1) * kPiece_px, weight.cols),
                                           [](uint8_t value) { return value == 255; }));
      }
  const auto ahead = static_cast<size_t>(params_.ahead);
  if (window_.size() == 2 * ahead + 1) window_.pop_front(), --at_;
  window_.push_back(std::move(waiting));
  if (window_.size() == 2 * ahead + 1)
    while (at_ <= ahead) known.push_back(Given());
}

BackgroundFrame Background::Mean() const {
  BackgroundFrame mean{cv::Mat(size_, type_), cv::Mat(size_, CV_8UC1)};
  const int pieces = PiecesOf(size_.width);
  const auto px_bytes = static_cast<int>(CV_ELEM_SIZE(type_));
  const MeanOfPiece mean_of = MeanOfType(type_);
  tbb::parallel_for(0, (size_.height + kRowsAtOnce - 1) / kRowsAtOnce, [&](int band) {
    std::vector<Part> parts;
    for (int y = band * kRowsAtOnce; y < std::min((band + 1) * kRowsAtOnce, size_.height); ++y)
      for (int piece = 0; piece < pieces; ++piece) {
        const int first = piece * kPiece_px, px = std::min(kPiece_px, size_.width - first);
        parts.clear();
        for (size_t k = 0; k < window_.size(); ++k) {
          const Waiting& from = window_[k];
          const bool full = from.full.empty() || from.full[static_cast<size_t>(y * pieces + piece)] != 0;
          parts.push_back({from.seen.frame.ptr(y) + first * px_bytes,
                           full ? nullptr : from.seen.weight.ptr(y) + first,
                           from.luck.empty() ? nullptr : from.luck.ptr(y) + first,
                           gaussian_[k < at_ ? at_ - k : k - at_]});
        }
        Before before{nullptr, nullptr};
        if (!before_.frame.empty())
          before = {before_.frame.ptr(y) + first * px_bytes, before_.seen.ptr(y) + first};
        mean_of(parts, before, px, mean.frame.ptr(y) + first * px_bytes, mean.seen.ptr(y) + first);
      }
  });
  return mean;
}

BackgroundFrame Background::Given() {
  before_ = Mean();
  ++at_;
  return before_;
}

}  // namespace shimmer::restore
