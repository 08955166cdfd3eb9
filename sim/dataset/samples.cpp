// Float pixels to the numbers in a file, and back.
#include <stdexcept>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {
namespace {

template <class Integer>
cv::Mat ToIntegers(const cv::Mat& image, int depth, double top) {
  cv::Mat samples(image.size(), CV_MAKETYPE(depth, image.channels()));
  const int row_samples = image.cols * image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const float* from = image.ptr<float>(y);
    Integer* to = samples.ptr<Integer>(y);
    for (int i = 0; i < row_samples; ++i) {
      const double clamped = from[i] > 0 ? (from[i] < 1 ? from[i] : 1) : 0;
      to[i] = static_cast<Integer>(cvRound(clamped * top));  // the product is exact, so ties are ties
    }
  }
  return samples;
}

template <class Integer>
cv::Mat FromIntegers(const cv::Mat& samples, float top) {
  cv::Mat image(samples.size(), CV_MAKETYPE(CV_32F, samples.channels()));
  const int row_samples = image.cols * image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const Integer* from = samples.ptr<Integer>(y);
    float* to = image.ptr<float>(y);
    for (int i = 0; i < row_samples; ++i) to[i] = from[i] / top;
  }
  return image;
}

// False for NaN.
bool IsInRange(const cv::Mat& image) {
  const int row_samples = image.cols * image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const float* row = image.ptr<float>(y);
    int outside = 0;
    for (int i = 0; i < row_samples; ++i) outside += !(row[i] >= -kMaxSample && row[i] <= kMaxSample);
    if (outside > 0) return false;
  }
  return true;
}

cv::Mat Finite(const cv::Mat& image) {
  if (IsInRange(image)) return image;  // nearly always
  cv::Mat finite = image.clone();
  const int row_samples = image.cols * image.channels();
  for (int y = 0; y < finite.rows; ++y) {
    float* row = finite.ptr<float>(y);
    for (int i = 0; i < row_samples; ++i) {
      if (row[i] > kMaxSample)
        row[i] = kMaxSample;
      else if (row[i] < -kMaxSample)
        row[i] = -kMaxSample;
      else if (row[i] != row[i])
        row[i] = 0;
    }
  }
  return finite;
}

}  // namespace

cv::Mat ToSamples(const cv::Mat& image, Encoding encoding) {
  const bool png = encoding.format == FileFormat::kPng;
  const int integers = encoding.bits == 8 ? CV_8U : CV_16U;
  if (png && !image.empty() && image.depth() == integers) return image;
  if (image.empty() || image.depth() != CV_32F)
    throw std::invalid_argument("a picture must be float32, or a PNG's own integers, and not empty");
  if (png && encoding.bits == 8) return ToIntegers<uint8_t>(image, CV_8U, 255);
  if (png && encoding.bits == 16) return ToIntegers<uint16_t>(image, CV_16U, 65535);
  if (!png && encoding.bits == 32) return Finite(image);
  if (!png && encoding.bits == 16) {
    cv::Mat half;
    Finite(image).convertTo(half, CV_16F);
    return half;
  }
  throw std::invalid_argument("bits = " + std::to_string(encoding.bits) + ", must be " +
                              (png ? "8 or 16 for png" : "16 (half) or 32 (float) for exr"));
}

cv::Mat FromSamples(const cv::Mat& samples) {
  switch (samples.depth()) {
    case CV_8U:
      return FromIntegers<uint8_t>(samples, 255.f);
    case CV_16U:
      return FromIntegers<uint16_t>(samples, 65535.f);
    default: {
      cv::Mat image;
      samples.convertTo(image, CV_32F);
      return image;
    }
  }
}

cv::Mat Quantise(const cv::Mat& image, Encoding encoding) { return FromSamples(ToSamples(image, encoding)); }

}  // namespace shimmer::dataset
