#include "sim/app/frame_compression.h"

#include "sim/app/clean_frames.h"
#include "sim/colour.h"

namespace shimmer::app {

cv::Mat FrameCompression::Through(const cv::Mat& samples) {
  const sim::SensorParams& sensor = config_.sensor;
  if (sensor.compression == sim::Compression::kNone) return samples;
  const bool linear = OutputIsLinear(config_);
  cv::Mat bytes = samples;
  if (samples.depth() != CV_8U) {
    cv::Mat light = samples.depth() == CV_32F ? samples : dataset::FromSamples(samples);
    if (linear) light = sim::EncodeSrgb(light);
    bytes = dataset::ToSamples(light, {.format = dataset::FileFormat::kPng, .bits = 8});
  }
  if (sensor.compression == sim::Compression::kJpeg) {
    bytes = dataset::ThroughJpeg(bytes, sensor.jpeg_quality);
  } else {
    if (!stream_) stream_.emplace(bytes.size(), bytes.channels(), sensor.h264_crf);
    bytes = stream_->Through(bytes);
  }
  if (samples.depth() == CV_8U) return bytes;
  cv::Mat light = dataset::FromSamples(bytes);
  if (linear) light = sim::DecodeSrgb(light);
  return samples.depth() == CV_32F ? light : dataset::ToSamples(light, EncodingOf(config_.output));
}

}  // namespace shimmer::app
