#include "sim/dataset/pixel_hash.h"

#include <bit>
#include <stdexcept>

#include "sim/dataset/files.h"
#include "sim/dataset/sha256.h"

namespace shimmer::dataset {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are hashed as they lie in memory");

const char* TypeName(int depth) {
  switch (depth) {
    case CV_8U:
      return "uint8";
    case CV_16U:
      return "uint16";
    case CV_16F:
      return "float16";
    case CV_32F:
      return "float32";
    default:
      throw std::invalid_argument("samples of a type that no file here has");
  }
}

}  // namespace

std::string PixelHashOfSamples(const cv::Mat& samples) {
  const std::string text = std::to_string(samples.cols) + " " + std::to_string(samples.rows) + " " +
                           std::to_string(samples.channels()) + " " + TypeName(samples.depth()) + "\n";
  Sha256 hash;
  hash.Add(AsBytes(text));
  for (int y = 0; y < samples.rows; ++y) hash.Add({samples.ptr(y), samples.cols * samples.elemSize()});
  return hash.Hex();
}

std::string PixelHash(const cv::Mat& image, Encoding encoding) {
  return PixelHashOfSamples(ToSamples(image, encoding));
}

}  // namespace shimmer::dataset
