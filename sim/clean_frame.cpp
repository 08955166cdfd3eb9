#include "sim/clean_frame.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "sim/colour.h"
#include "sim/pack_rows.h"
#include "sim/warp.h"

namespace shimmer::sim {
namespace {

template <class Sample>
bool ChannelsAreEqual(const cv::Mat& rgb) {
  for (int y = 0; y < rgb.rows; ++y) {
    const Sample* row = rgb.ptr<Sample>(y);
    bool equal = true;
    for (int x = 0; x < rgb.cols; ++x, row += 3) equal &= row[0] == row[1] && row[1] == row[2];
    if (!equal) return false;
  }
  return true;
}

bool IsGrey(const cv::Mat& samples) {
  if (samples.channels() == 1) return true;
  switch (samples.depth()) {
    case CV_8U:
      return ChannelsAreEqual<uint8_t>(samples);
    case CV_16U:
      return ChannelsAreEqual<uint16_t>(samples);
    default:
      return ChannelsAreEqual<float>(samples);
  }
}

void RequireFiniteLight(const cv::Mat& frame) {
  for (int y = 0; y < frame.rows; ++y) {
    const float* row = frame.ptr<float>(y);
    for (int i = 0; i < frame.cols * frame.channels(); ++i)
      if (!(std::abs(row[i]) <= kMostLight))
        throw std::invalid_argument("clean frame: a sample of pixel (" +
                                    std::to_string(i / frame.channels()) + ", " + std::to_string(y) +
                                    ") is " + std::to_string(row[i]) + ", must be in [-65504, 65504]");
  }
}

cv::Mat Checked(const cv::Mat& samples) {
  const int depth = samples.depth(), channels = samples.channels();
  if (samples.empty() || (depth != CV_8U && depth != CV_16U && depth != CV_32F) ||
      (channels != 1 && channels != 3))
    throw std::invalid_argument("clean frame of type " + cv::typeToString(samples.type()) +
                                ", must be CV_8U, CV_16U or CV_32F with 1 or 3 channels");
  if (depth == CV_32F) RequireFiniteLight(samples);
  return samples;
}

// Without OpenCV's conversions, whose last bit depends on the CPU.
cv::Mat ToFloat(const cv::Mat& samples) {
  cv::Mat light(samples.size(), CV_32FC(samples.channels()));
  const cv::Mat one_channel = samples.reshape(1);
  const auto count = static_cast<size_t>(one_channel.cols);
  for (int y = 0; y < samples.rows; ++y) {
    float* const row = light.ptr<float>(y);
    UnpackRow(one_channel, {0, y}, count, &row);
  }
  return light;
}

cv::Mat LightOf(const cv::Mat& samples, bool grey, bool linear_light) {
  cv::Mat light = samples;
  if (grey && samples.channels() == 3) cv::extractChannel(samples, light, 0);
  return linear_light ? DecodeSrgb(ToFloat(light)) : light;
}

}  // namespace

CleanFrame::CleanFrame(const cv::Mat& given, cv::Point origin_, const ClipPlan& plan)
    : origin(origin_),
      samples(Checked(given)),
      constant(samples),
      grey(samples.channels() == 1 || (!plan.sensor && plan.objects == 0 && IsGrey(samples))),
      linear_light(plan.linear_light),
      light(LightOf(samples, grey, linear_light)),
      source(plan.tilt || plan.shake ? PrepareForWarp(light) : cv::Mat()) {}

void CleanFrame::Derive(cv::Rect area) {
  const cv::Mat part = Checked(samples(area));
  constant.SetVaried(area);
  if (light.data != samples.data) LightOf(part, grey, linear_light).copyTo(light(area));
  if (!source.empty() && source.data != light.data) PrepareForWarp(light(area)).copyTo(source(area));
}

}  // namespace shimmer::sim
