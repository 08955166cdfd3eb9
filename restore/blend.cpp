#include "restore/blend.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "restore/levels.h"
#include "restore/membrane.h"

namespace shimmer::restore {
namespace {

constexpr double kTolerance_levels = 0.05;

template <class Sample>
cv::Mat BlendedOf(const cv::Mat& frame, const cv::Mat& background, const cv::Mat& mask) {
  const int channels = frame.channels();
  const auto to_levels = static_cast<float>(255 / WhiteOf(frame.depth()));
  const Membrane membrane(mask);
  const auto difference = [&](cv::Point px) {
    const auto* of = frame.ptr<Sample>(px.y) + px.x * channels;
    const auto* with = background.ptr<Sample>(px.y) + px.x * channels;
    Sample4 result;
    for (int c = 0; c < channels; ++c) {
      result.v[c] = (static_cast<float>(with[c]) - static_cast<float>(of[c])) * to_levels;
      if (!(std::abs(result.v[c]) <= kMostOffset_levels)) return Sample4();  // (or is not finite)
    }
    return result;
  };
  const CellValues surface = membrane.Solve(difference, kTolerance_levels);
  cv::Mat blended = background.clone();
  for (const CellRun& run : membrane.runs()) {
    const auto* of = frame.ptr<Sample>(run.y);
    const auto* sure = mask.ptr<uint8_t>(run.y);
    auto* to = blended.ptr<Sample>(run.y);
    for (int x = run.begin; x < run.end; ++x) {
      const Sample4::Lanes lift = surface[static_cast<size_t>(run.first + x - run.begin)].v / to_levels;
      const float share = static_cast<float>(sure[x]) / 255;
      for (int c = 0; c < channels; ++c) {
        const int i = x * channels + c;
        const float front = static_cast<float>(of[i]) + lift[c];
        // (all of the frame exactly: a sum of both shares would round)
        const float behind = static_cast<float>(to[i]);
        to[i] = cv::saturate_cast<Sample>(sure[x] == 255 ? front : behind + share * (front - behind));
      }
    }
  }
  return blended;
}

}  // namespace

cv::Mat Blended(const cv::Mat& frame, const cv::Mat& background, const cv::Mat& mask) {
  RequireFrame(frame, "frame");
  if (background.size() != frame.size() || background.type() != frame.type())
    throw std::invalid_argument("background: is of another size or type than the frame");
  if (mask.type() != CV_8UC1 || mask.size() != frame.size())
    throw std::invalid_argument("mask: must be CV_8UC1 and of the frame's size");
  return frame.depth() == CV_8U    ? BlendedOf<uint8_t>(frame, background, mask)
         : frame.depth() == CV_16U ? BlendedOf<uint16_t>(frame, background, mask)
                                   : BlendedOf<float>(frame, background, mask);
}

}  // namespace shimmer::restore
