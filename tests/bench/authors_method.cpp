#include "tests/bench/authors_method.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "sim/draw.h"
#include "tests/bench/scalar_noise.h"
#include "tests/bench/step.h"

namespace shimmer::bench {
namespace {

constexpr int kLevels = 11;  // beside the frame itself
constexpr double kLargestOrigin = 500'000;

std::array<double, 3> DrawOrigin(const std::string& path, double largest) {
  std::array<double, 3> origin;
  for (size_t axis = 0; axis < 3; ++axis)
    origin[axis] = sim::DrawUniform(kBenchClip, path + std::to_string(axis), 0, largest);
  return origin;
}

noise::Origin FixedOrigin(const std::array<double, 3>& origin) {
  return {noise::Fixed::FromDouble(origin[0]), noise::Fixed::FromDouble(origin[1]),
          noise::Fixed::FromDouble(origin[2])};
}

// The frame's own extremes become 0 and the largest sigma.
cv::Mat Stretched(const cv::Mat& noise, double max_sigma_px) {
  double least, largest;
  cv::minMaxLoc(noise, &least, &largest);
  const double scale = largest > least ? max_sigma_px / (largest - least) : 0;
  cv::Mat sigma;
  noise.convertTo(sigma, CV_32F, scale, -least * scale);
  return cv::max(sigma, 0.0);
}

}  // namespace

AuthorsMethod::AuthorsMethod(const sim::Scene& scene, cv::Size size, int frames, AuthorsMode mode)
    : scene_(scene),
      size_(size),
      frames_(frames),
      mode_(mode),
      origin_x_(DrawOrigin("authors.x", kLargestOrigin)),
      origin_y_(DrawOrigin("authors.y", kLargestOrigin)),
      blur_origin_(DrawOrigin("authors.blur", noise::kPeriodCells)) {}

cv::Mat AuthorsMethod::Field(const Place& origin, int t) const {
  const double f = scene_.tilt.base_frequency;
  const auto z = static_cast<float>(origin[2] + f * scene_.tilt.temporal_scale * t);
  cv::Mat field(size_, CV_32F);
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x)
      field.at<float>(y, x) =
          static_cast<float>(scene_.tilt.strength_px) *
          ScalarOctaves(ScalarSimplex, scene_.tilt.octaves, static_cast<float>(origin[0] + f * x),
                        static_cast<float>(origin[1] + f * y), z);
  return field;
}

std::vector<AuthorsMethod::Shifts> AuthorsMethod::ClipShifts() const {
  std::vector<Shifts> clip(static_cast<size_t>(frames_));
  for (int t = 0; t < frames_; ++t) clip[t].dx = Field(origin_x_, t);
  for (int t = 0; t < frames_; ++t)
    clip[t].dy = mode_ == AuthorsMode::kFast ? clip[Mirrored(t)].dx : Field(origin_y_, t);
  return clip;
}

cv::Mat AuthorsMethod::SigmaMap(int t) const {
  const double f = scene_.blur.base_frequency;
  const auto z = static_cast<float>(blur_origin_[2] + f * scene_.blur.temporal_scale * t);
  cv::Mat noise(size_, CV_32F);
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x)
      noise.at<float>(y, x) =
          ScalarOctaves(ScalarPerlin, scene_.blur.octaves, static_cast<float>(blur_origin_[0] + f * x),
                        static_cast<float>(blur_origin_[1] + f * y), z);
  return Stretched(noise, scene_.blur.max_sigma_px);
}

cv::Mat AuthorsMethod::Warp(const cv::Mat& clean, const Shifts& shifts) const {
  cv::Mat warped(size_, clean.type());
  const size_t pixel_bytes = clean.elemSize();
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x) {
      const int from_x = static_cast<int>(std::floor(static_cast<float>(x) + shifts.dx.at<float>(y, x))),
                from_y = static_cast<int>(std::floor(static_cast<float>(y) + shifts.dy.at<float>(y, x)));
      const uchar* from = clean.ptr(std::clamp(from_y, 0, size_.height - 1)) +
                          std::clamp(from_x, 0, size_.width - 1) * pixel_bytes;
      std::copy_n(from, pixel_bytes, warped.ptr(y) + x * pixel_bytes);
    }
  return warped;
}

cv::Mat AuthorsMethod::Blur(const cv::Mat& warped, const cv::Mat& sigma) const {
  const double step_px = scene_.blur.max_sigma_px / kLevels;
  std::vector<cv::Mat> levels{warped};
  for (int level = 1; level <= kLevels; ++level) {
    // Variances add: from level - 1 to level.
    const double added_px = step_px * std::sqrt(2.0 * level - 1);
    cv::Mat blurred;
    cv::GaussianBlur(levels.back(), blurred, {}, added_px, added_px, cv::BORDER_REPLICATE);
    levels.push_back(blurred);
  }
  cv::Mat out(size_, warped.type());
  const size_t pixel_bytes = warped.elemSize();
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x) {
      const int level = std::min(static_cast<int>(sigma.at<float>(y, x) / step_px), kLevels);
      std::copy_n(levels[level].ptr(y) + x * pixel_bytes, pixel_bytes, out.ptr(y) + x * pixel_bytes);
    }
  return out;
}

std::vector<cv::Mat> AuthorsMethod::RenderClip(const cv::Mat& clean) const {
  const std::vector<Shifts> shifts = ClipShifts();
  std::vector<cv::Mat> frames;
  for (int t = 0; t < frames_; ++t) frames.push_back(Blur(Warp(clean, shifts[t]), SigmaMap(t)));
  return frames;
}

cv::Mat AuthorsMethod::ExactField(const Place& origin, int t) const {
  const noise::OctaveParams params{.octaves = scene_.tilt.octaves,
                                   .base_frequency = scene_.tilt.base_frequency,
                                   .temporal_scale = scene_.tilt.temporal_scale,
                                   .peak = scene_.tilt.strength_px};
  const noise::SimplexOctaves octaves(noise::ClassicOctaves(params, FixedOrigin(origin)),
                                      noise::kSimplexKernel06);
  cv::Mat field(size_, CV_64F);
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x) field.at<double>(y, x) = octaves.Double(t, y, x);
  return field;
}

AuthorsMethod::Shifts AuthorsMethod::ExactShifts(int t) const {
  return {ExactField(origin_x_, t),
          mode_ == AuthorsMode::kFast ? ExactField(origin_x_, Mirrored(t)) : ExactField(origin_y_, t)};
}

cv::Mat AuthorsMethod::ExactSigmaMap(int t) const {
  const noise::PerlinOctaves octaves(noise::ClassicOctaves({.octaves = scene_.blur.octaves,
                                                            .base_frequency = scene_.blur.base_frequency,
                                                            .temporal_scale = scene_.blur.temporal_scale},
                                                           FixedOrigin(blur_origin_)));
  cv::Mat noise(size_, CV_64F);
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x) noise.at<double>(y, x) = octaves.Double(t, y, x);
  return Stretched(noise, scene_.blur.max_sigma_px);
}

}  // namespace shimmer::bench
