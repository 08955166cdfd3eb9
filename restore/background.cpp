#include "restore/background.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/levels.h"
#include "restore/weighted_mean.h"

namespace shimmer::restore {
namespace {

constexpr int kMostAhead = 14;
constexpr double kFullWindow_px = 1;  // tilt from which on it is the longest
constexpr double kLeastRegistered_px = 0.25;
constexpr int kFilledShare = 4;    // a filled px counts that many times less
constexpr float kEnough = 0.25f;   // share of the weights that needs no background before
constexpr float kNothing = 0.01f;  // share of the weights that is as good as nothing
constexpr int kPiece_px = 128;     // of a row; its sums stay in the first cache

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

// One frame of the window at one piece of a row.
struct Part {
  const uint8_t* row;
  const uint8_t* weight;  // nullptr: all 255
  float gaussian;
};

// What is known before, at that piece; nullptr if nothing is.
struct Before {
  const uint8_t *row, *seen;
};

// The mean of a piece of px, and where it is seen.
template <class Sample, int kChannels>
void MeanOf(const std::vector<Part>& parts, const Before& before, int px, uint8_t* to_bytes, uint8_t* seen) {
  std::array<float, kPiece_px * kChannels> sum{}, as_they_are{};
  std::array<float, kPiece_px> weights{};
  const int count = px * kChannels;
  float full = 0, all = 0;  // weights of all px of parts that have no mask; and of all parts
  bool masked = false;
  const auto samples = [](const Part& part) { return reinterpret_cast<const Sample*>(part.row); };
  std::array<const Sample*, 4> rows{};  // that wait for others, to be added at once
  std::array<float, 4> shares{};
  size_t waiting = 0;
  for (const Part& part : parts) {
    all += part.gaussian;
    if (part.weight != nullptr) {
      AddWeighed<kChannels>(samples(part), part.weight, part.gaussian, px, sum.data(), weights.data());
      masked = true;
      continue;
    }
    full += part.gaussian;
    rows[waiting] = samples(part), shares[waiting] = part.gaussian;
    if (++waiting < rows.size()) continue;
    AddSamples(rows, shares, count, sum.data());
    waiting = 0;
  }
  for (size_t k = 0; k < waiting; ++k) AddSamples(rows[k], shares[k], count, sum.data());

  auto* to = reinterpret_cast<Sample*>(to_bytes);
  std::fill(seen, seen + px, uint8_t{255});
  if (!masked) {
    const float scale = 1 / full;
    for (int i = 0; i < count; ++i) to[i] = cv::saturate_cast<Sample>(sum[static_cast<size_t>(i)] * scale);
    return;
  }
  bool mixed = false;
  for (int x = 0; x < px; ++x) {
    const float own = full + weights[static_cast<size_t>(x)];
    const bool known = before.row != nullptr && before.seen[x] != 0;
    const float missing = std::max(0.0f, (known ? kEnough : kNothing) * all - own);
    if (!known && missing > 0 && !mixed) {
      for (const Part& part : parts)
        AddSamples(samples(part), part.gaussian / all, count, as_they_are.data());
      mixed = true;
    }
    const auto* last = reinterpret_cast<const Sample*>(before.row);
    for (int i = x * kChannels; i < (x + 1) * kChannels; ++i) {
      const auto k = static_cast<size_t>(i);
      float value = sum[k];
      if (missing > 0) value += missing * (known ? static_cast<float>(last[i]) : as_they_are[k]);
      to[i] = cv::saturate_cast<Sample>(value / (own + missing));
    }
    if (!known && missing > 0) seen[x] = 0;
  }
}

using MeanOfPiece = void (*)(const std::vector<Part>&, const Before&, int, uint8_t*, uint8_t*);

template <class Sample>
MeanOfPiece MeanOfChannels(int channels) {
  return channels == 1 ? MeanOf<Sample, 1> : MeanOf<Sample, 3>;
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
  for (int k = 0; k <= params_.ahead; ++k)
    gaussian_.push_back(
        static_cast<float>(std::exp(-0.5 * std::pow(k / std::max(params_.ahead / 2.0, 0.5), 2))));
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

std::optional<BackgroundFrame> Background::Next(const SteadyFrame& steady, const cv::Mat& moving) {
  RequireFrame(steady.frame, "frame");
  if (type_ == -1) size_ = steady.frame.size(), type_ = steady.frame.type();
  if (steady.frame.size() != size_ || steady.frame.type() != type_)
    throw std::invalid_argument("frame: is of another size or type than the first");
  WeighedFrame frame{steady.frame, WeightOf(steady.own, moving, size_)};
  if (registration_) {
    for (WeighedFrame& registered : registration_->Next(std::move(frame))) Add(std::move(registered));
  } else {
    Add(std::move(frame));
  }
  if (at_ + static_cast<size_t>(params_.ahead) >= window_.size()) return {};
  return Given();
}

std::optional<BackgroundFrame> Background::Rest() {
  if (registration_)
    for (WeighedFrame& registered : registration_->Rest()) Add(std::move(registered));
  if (at_ >= window_.size()) return {};
  return Given();
}

void Background::Add(WeighedFrame frame) {
  Waiting waiting{std::move(frame), {}};
  if (const cv::Mat& weight = waiting.seen.weight; !weight.empty())
    for (int y = 0; y < weight.rows; ++y)
      for (int piece = 0; piece < PiecesOf(weight.cols); ++piece) {
        const auto* row = weight.ptr<uint8_t>(y);
        waiting.full.push_back(std::all_of(row + piece * kPiece_px,
                                           row + std::min((piece + 1) * kPiece_px, weight.cols),
                                           [](uint8_t value) { return value == 255; }));
      }
  window_.push_back(std::move(waiting));
}

BackgroundFrame Background::Mean() const {
  BackgroundFrame mean{cv::Mat(size_, type_), cv::Mat(size_, CV_8UC1)};
  const int pieces = PiecesOf(size_.width), channels = CV_MAT_CN(type_);
  const auto px_bytes = static_cast<int>(CV_ELEM_SIZE(type_));
  const int depth = CV_MAT_DEPTH(type_);
  const MeanOfPiece mean_of = depth == CV_8U    ? MeanOfChannels<uint8_t>(channels)
                              : depth == CV_16U ? MeanOfChannels<uint16_t>(channels)
                                                : MeanOfChannels<float>(channels);
  const size_t end = std::min(window_.size(), at_ + static_cast<size_t>(params_.ahead) + 1);
  tbb::parallel_for(0, (size_.height + kRowsAtOnce - 1) / kRowsAtOnce, [&](int band) {
    std::vector<Part> parts;
    for (int y = band * kRowsAtOnce; y < std::min((band + 1) * kRowsAtOnce, size_.height); ++y)
      for (int piece = 0; piece < pieces; ++piece) {
        const int first = piece * kPiece_px, px = std::min(kPiece_px, size_.width - first);
        parts.clear();
        for (size_t k = 0; k < end; ++k) {
          const Waiting& from = window_[k];
          const bool full = from.full.empty() || from.full[static_cast<size_t>(y * pieces + piece)] != 0;
          parts.push_back({from.seen.frame.ptr(y) + first * px_bytes,
                           full ? nullptr : from.seen.weight.ptr(y) + first,
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

std::optional<BackgroundFrame> Background::Given() {
  before_ = Mean();
  ++at_;
  while (at_ > static_cast<size_t>(params_.ahead)) window_.pop_front(), --at_;
  return before_;
}

}  // namespace shimmer::restore
