#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>

#include "sim/dataset/image_io.h"
#include "sim/dataset/oiio_setup.h"
#include "sim/dataset/png_write.h"

namespace shimmer::dataset {
namespace {

// zlib's quickest level with one fixed filter: a fifth of the time of the defaults for files 4 % larger
// (photograph).
constexpr int kPngLevel = 1;
constexpr int kPngFilterAverage = 0x40;

OIIO::ImageSpec SpecOf(const cv::Mat& samples, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(samples.cols, samples.rows, samples.channels(), type);
  spec["DateTime"] = "";  // or else the writers put in the time of day
  return spec;
}

std::vector<uint8_t> Write(const char* format, const OIIO::ImageSpec& spec, const cv::Mat& samples) {
  SetUpOpenImageIO();
  std::vector<uint8_t> bytes;
  // All that it will be (16 bytes a row are of the format): growing would copy it several times.
  if (spec.get_string_attribute("compression") == "none")
    bytes.reserve(spec.image_bytes() + spec.height * 16 + 4096);
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) throw std::runtime_error(std::string(format) + ": OpenImageIO has no writer for it");
  output->set_ioproxy(&memory);
  // The name says nothing but the format: nothing is written to disk.
  const bool written = output->open(std::string("memory.") + format, spec) &&
                       output->write_image(spec.format, samples.data, OIIO::AutoStride, samples.step) &&
                       output->close();
  if (!written || output->has_error())
    throw std::runtime_error(std::string(format) + ": can't be encoded: " + output->geterror());
  return bytes;
}

std::vector<uint8_t> WriteExr(const cv::Mat& samples, std::span<const std::string> channels,
                              const char* compression) {
  OIIO::ImageSpec spec = SpecOf(samples, samples.depth() == CV_16F ? OIIO::TypeHalf : OIIO::TypeFloat);
  spec.channelnames.assign(channels.begin(), channels.end());
  spec.alpha_channel = -1;
  spec["compression"] = compression;
  return Write("exr", spec, samples);
}

// Whether a tenth or more of the file is saved, by a few rows spread over the picture. Computed floats, as
// those of truth, fill their 24 bits: zips would take 30 times as long, to find every row no smaller and
// store it as it is.
bool ZipsHelps(const cv::Mat& samples, std::span<const std::string> channels) {
  cv::Mat rows(std::min(samples.rows, 16), samples.cols, samples.type());
  for (int i = 0; i < rows.rows; ++i)
    samples.row((2 * i + 1) * samples.rows / (2 * rows.rows)).copyTo(rows.row(i));
  return WriteExr(rows, channels, "zips").size() < 0.9 * WriteExr(rows, channels, "none").size();
}

void RequireNames(const cv::Mat& image, std::span<const std::string> channels) {
  if (image.channels() != static_cast<int>(channels.size()))
    throw std::invalid_argument("an EXR of " + std::to_string(image.channels()) + " channels with " +
                                std::to_string(channels.size()) + " names");
}

}  // namespace

const char* Extension(FileFormat format) { return format == FileFormat::kPng ? "png" : "exr"; }

std::vector<uint8_t> EncodePng(const cv::Mat& image, int bits, PngWriter writer) {
  const cv::Mat samples = ToSamples(image, {FileFormat::kPng, bits});
  if (writer == PngWriter::kIsal) return WritePng(samples);
  if (image.channels() != 1 && image.channels() != 3)
    throw std::invalid_argument("a PNG of " + std::to_string(image.channels()) +
                                " channels, by OpenImageIO must be 1 or 3");
  OIIO::ImageSpec spec = SpecOf(samples, bits == 8 ? OIIO::TypeUInt8 : OIIO::TypeUInt16);
  spec["png:compressionLevel"] = kPngLevel;
  spec["png:filter"] = kPngFilterAverage;
  return Write("png", spec, samples);
}

std::vector<uint8_t> EncodeExr(const cv::Mat& image, int bits, std::span<const std::string> channels) {
  RequireNames(image, channels);
  const cv::Mat samples = ToSamples(image, {FileFormat::kExr, bits});
  if (bits == 32 && !ZipsHelps(samples, channels)) return WriteExr(samples, channels, "none");
  return WriteExr(samples, channels, "zips");
}

std::vector<uint8_t> EncodeExrAsIs(const cv::Mat& image, std::span<const std::string> channels) {
  RequireNames(image, channels);
  if (image.empty() || image.depth() != CV_32F)
    throw std::invalid_argument("an EXR of numbers as they are must be float32, and not empty");
  return WriteExr(image, channels, "zips");
}

std::vector<uint8_t> EncodeJpeg(const cv::Mat& image, int quality, JpegColour colour) {
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3)
    throw std::invalid_argument("a JPEG of " + cv::typeToString(image.type()) +
                                ", must be CV_8UC1 or CV_8UC3");
  if (image.empty() || image.cols > kMaxSide_px || image.rows > kMaxSide_px)
    throw std::invalid_argument("a JPEG of " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                                " px, must be 1 to " + std::to_string(kMaxSide_px) + " each way");
  if (quality < 1 || quality > 100)
    throw std::invalid_argument("quality = " + std::to_string(quality) + ", must be in [1, 100]");
  const cv::Mat samples = image.isContinuous() ? image : image.clone();
  OIIO::ImageSpec spec = SpecOf(samples, OIIO::TypeUInt8);
  spec["Compression"] = "jpeg:" + std::to_string(quality);
  spec["jpeg:subsampling"] = colour == JpegColour::kFull ? "4:4:4" : "4:2:0";
  return Write("jpeg", spec, samples);
}

std::vector<uint8_t> EncodeImage(const cv::Mat& image, Encoding encoding) {
  if (encoding.format == FileFormat::kPng) return EncodePng(image, encoding.bits, encoding.png_writer);
  static const std::vector<std::string> grey = {"Y"}, colour = {"R", "G", "B"};
  return EncodeExr(image, encoding.bits, image.channels() == 1 ? grey : colour);
}

}  // namespace shimmer::dataset
