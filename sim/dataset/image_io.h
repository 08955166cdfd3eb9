// Pictures on disk and in memory. In memory: cv::Mat, float32 or a file's own samples, grey or RGB,
// [y][x][channel].
//
// Errors: std::runtime_error "PATH: what is wrong" for a file, std::invalid_argument for a wrong argument.
// OpenImageIO's own threads are switched off for the whole process by the first call: callers run one clip a
// thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

namespace shimmer::dataset {

inline constexpr int kMaxSide_px = 32768;     // larger pictures are refused before memory is asked for
inline constexpr float kMaxSample = 65504.f;  // largest half

// ---- Reading
// -----------------------------------------------------------------------------------------------------

struct Picture {
  cv::Mat pixels;              // of 1 or 3 (RGB) channels, upright (a camera's orientation tag is obeyed)
  bool linear = false;         // values are linear light: EXR and other float formats
  bool alpha_dropped = false;  // the file has an alpha channel, which is not in pixels
  int64_t replaced =
      0;  // samples that were NaN (now 0) or beyond +-kMaxSample, Inf included (now +-kMaxSample)
};

// Reads whatever OpenImageIO reads, its first picture where there are more; values as stored (no transfer
// changed, colour not multiplied by alpha). Integers are scaled to [0, 1]: 8 bits v / 255.f, 16 bits v /
// 65535.f. One channel (or one and alpha) is grey, R, G and B by name or else the first three of three or
// more are RGB. Refused: no file, not a picture, cut off or otherwise damaged, two channels without alpha,
// over kMaxSide_px. Its pixels are CV_32F. bytes, where not empty: the file's, read already (of a file in a
// tar); path then only names it.
Picture ReadImage(const std::filesystem::path& path, std::span<const uint8_t> bytes = {});

// The same, its pixels the file's own samples: CV_8U, CV_16U, or CV_32F for any other kind of number.
// FromSamples makes ReadImage's of them.
Picture ReadSamples(const std::filesystem::path& path, std::span<const uint8_t> bytes = {});

// The named channels of a float file, in the order of the names, CV_32FC(n). Values as they are, NaN too.
// Empty if one of them is not in the file.
cv::Mat ReadChannels(const std::filesystem::path& path, std::span<const std::string> names,
                     std::span<const uint8_t> bytes = {});

// A picture with alpha, to be laid over another.
struct CutoutPicture {
  cv::Mat rgb;    // CV_32FC3, not multiplied by alpha; black where alpha is 0
  cv::Mat alpha;  // CV_32FC1 in [0, 1]
  bool linear = false;
};

// Grey and alpha, or RGB and alpha; EXR, whose colours are multiplied by alpha, too. What is not finite is 0.
// Throws std::runtime_error as ReadImage, and for a picture without alpha.
CutoutPicture ReadCutout(const std::filesystem::path& path);

// All channels of a file of ours, in its order, as the numbers that are in it: CV_8U, CV_16U, CV_16F or
// CV_32F, as ToSamples gives them.
cv::Mat StoredSamples(const std::filesystem::path& path, std::span<const uint8_t> bytes = {});

// Extensions of the files that ReadImage may read, lower case without dot ("png").
const std::vector<std::string>& PictureExtensions();

// ---- Writing
// -----------------------------------------------------------------------------------------------------

enum class FileFormat { kPng, kExr };
enum class PngWriter { kIsal, kOpenImageIo };  // ours (png_write.h), quick; or OpenImageIO's

struct Encoding {
  FileFormat format = FileFormat::kPng;
  int bits = 8;  // PNG: 8 or 16. EXR: 16 (half) or 32 (float)
  PngWriter png_writer = PngWriter::kIsal;
};

// The samples that a file of this encoding holds, as CV_8U, CV_16U, CV_16F or CV_32F with the channels of
// image:
//   PNG: image in [0, 1] (clamped, NaN is 0) times 255 or 65535, to the nearest integer, ties to the even
//   one; EXR: NaN is 0, clamped to +-kMaxSample; half to the nearest, ties to even.
// An image that is its samples already (CV_8U for a PNG of 8 bits, CV_16U for 16, floats within the range for
// an EXR of 32) is given back as it is, with the same memory; other results are continuous.
// Throws std::invalid_argument if image is empty or of another type, or if the format has no such bits.
cv::Mat ToSamples(const cv::Mat& image, Encoding encoding);

// What reading a file with these samples gives: float32.
cv::Mat FromSamples(const cv::Mat& samples);

// FromSamples(ToSamples(image)): exactly what ReadImage gives back of the written image.
cv::Mat Quantise(const cv::Mat& image, Encoding encoding);

// A whole file as bytes; the same bytes for the same picture, on any day.
// PNG: 1 to 4 channels (by OpenImageIO 1 or 3), no colour chunk. EXR: one name a channel; compressed by zips,
// or, of 32 bits, not at all where that would save less than a tenth.
std::vector<uint8_t> EncodePng(const cv::Mat& image, int bits, PngWriter writer = PngWriter::kIsal);
std::vector<uint8_t> EncodeExr(const cv::Mat& image, int bits, std::span<const std::string> channels);

// Of 32 bits, and with every number as it is: for maps in which NaN says that nothing is known.
std::vector<uint8_t> EncodeExrAsIs(const cv::Mat& image, std::span<const std::string> channels);

// A frame: PNG, or EXR with the channels Y or R, G, B.
std::vector<uint8_t> EncodeImage(const cv::Mat& image, Encoding encoding);

// Colour as fine as brightness (4:4:4), for people to look at; or one for 2x2 pixels (4:2:0), as of cameras.
enum class JpegColour { kFull, kHalved };

// image: CV_8UC1 or CV_8UC3 (RGB), each side up to kMaxSide_px; quality in [1, 100]. Throws
// std::invalid_argument for anything else.
std::vector<uint8_t> EncodeJpeg(const cv::Mat& image, int quality, JpegColour colour = JpegColour::kFull);

// An animation that repeats for ever; frames: CV_8UC3 RGB of one size; each shown for delay_ms, rounded to 10
// ms.
std::vector<uint8_t> EncodeGif(std::span<const cv::Mat> frames, int delay_ms);

const char* Extension(FileFormat format);  // "png", "exr"

}  // namespace shimmer::dataset
