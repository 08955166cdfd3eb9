#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>
#include <stdexcept>

#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"
#include "sim/dataset/mapped_memory.h"
#include "sim/dataset/oiio_setup.h"
#include "sim/dataset/png_check.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& path, std::string what) {
  // One line: a library's own text may be several.
  std::replace(what.begin(), what.end(), '\n', ' ');
  throw std::runtime_error(path.string() + ": " + what);
}

void RequirePicture(const fs::path& path) {
  RequireFile(path);
  if (!LooksLikePng(ReadStart(path, 8))) return;
  if (const auto damage = PngDamage(ReadFile(path))) Fail(path, "damaged picture: PNG " + *damage);
}

// An open picture, and where its bytes come from if that is no file.
struct Input {
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  // destroyed after what reads from it
  std::unique_ptr<OIIO::ImageInput> input;

  OIIO::ImageInput& operator*() const { return *input; }
  OIIO::ImageInput* operator->() const { return input.get(); }
};

Input Open(const fs::path& path, std::span<const uint8_t> bytes) {
  SetUpOpenImageIO();
  OIIO::ImageSpec wish;
  wish["oiio:UnassociatedAlpha"] = 1;
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
  if (bytes.empty()) {
    RequirePicture(path);
    input = OIIO::ImageInput::open(path.string(), &wish);
  } else {
    if (LooksLikePng(bytes))
      if (const auto damage = PngDamage(bytes)) Fail(path, "damaged picture: PNG " + *damage);
    memory =
        std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<uint8_t*>(bytes.data()), bytes.size());
    // By its format: given a path, OpenImageIO looks for a file there.
    const std::string extension = path.extension().string();
    if (!extension.empty()) input = OIIO::ImageInput::create(extension.substr(1));
    OIIO::ImageSpec ignored;
    if (input && !(input->set_ioproxy(memory.get()) && input->open(path.string(), ignored, wish)))
      Fail(path, "not a picture that can be read (" + input->geterror() + ")");
  }
  if (!input) Fail(path, "not a picture that can be read (" + OIIO::geterror() + ")");
  if (input->format_name() == std::string("FFmpeg movie")) Fail(path, "a video, must be a picture");
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep || spec.depth > 1) Fail(path, "a deep or volume picture, must be flat");
  if (spec.width < 1 || spec.height < 1) Fail(path, "a picture without pixels");
  if (spec.width > kMaxSide_px || spec.height > kMaxSide_px)
    Fail(path, "too large: " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   ", must be within " + std::to_string(kMaxSide_px) + " a side");
  return {std::move(memory), std::move(input)};
}

// The channels that make the picture, by their index in the file.
std::vector<int> ColourChannels(const fs::path& path, const OIIO::ImageSpec& spec) {
  const std::vector<int> named = {spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (std::ranges::count(named, -1) == 0) return named;
  if (spec.nchannels == 1) return {0};
  std::vector<int> colours;
  for (int c = 0; c < spec.nchannels && colours.size() < 3; ++c)
    if (c != spec.alpha_channel) colours.push_back(c);
  if (colours.size() == 2) Fail(path, "two channels and no alpha, must be grey or RGB");
  return colours;
}

cv::Mat NewPicture(int rows, int cols, int type) {
  cv::Mat picture;
  picture.allocator = MappedMemory();
  picture.create(rows, cols, type);
  return picture;
}

// The picked channels as the file holds them: CV_8U, CV_16U, or CV_32F for any other kind of number.
cv::Mat ReadPicked(const fs::path& path, OIIO::ImageInput& input, const std::vector<int>& picked) {
  const OIIO::ImageSpec& spec = input.spec();
  const auto [first, last] = std::ranges::minmax(picked);
  const int channels = last - first + 1;
  if (channels > CV_CN_MAX) Fail(path, "its colour channels are too far apart");
  OIIO::TypeDesc type = OIIO::TypeFloat;
  if (spec.channelformats.empty() && (spec.format == OIIO::TypeUInt8 || spec.format == OIIO::TypeUInt16))
    type = spec.format;
  const int depth = type == OIIO::TypeUInt8 ? CV_8U : type == OIIO::TypeUInt16 ? CV_16U : CV_32F;
  try {
    const cv::Mat all = NewPicture(spec.height, spec.width, CV_MAKETYPE(depth, channels));
    const bool read = input.read_image(0, 0, first, last + 1, type, all.data);
    // JPEG: a file that is cut off reads as grey and leaves only a message.
    const std::string message = input.geterror();
    if (!read || !message.empty())
      Fail(path, "damaged picture (" + (message.empty() ? "cut off" : message) + ")");
    if (channels == static_cast<int>(picked.size()) && std::ranges::is_sorted(picked)) return all;
    cv::Mat chosen = NewPicture(all.rows, all.cols, CV_MAKETYPE(depth, static_cast<int>(picked.size())));
    std::vector<int> from_to;
    for (size_t i = 0; i < picked.size(); ++i)
      from_to.insert(from_to.end(), {picked[i] - first, static_cast<int>(i)});
    cv::mixChannels(&all, 1, &chosen, 1, from_to.data(), picked.size());
    return chosen;
  } catch (const std::bad_alloc&) {
    Fail(path, "not enough memory for its pixels");
  } catch (const cv::Exception& error) {
    Fail(path, "can't be held in memory (" + error.err + ")");
  }
}

int64_t ReplaceNonFinite(cv::Mat& pixels) {
  int64_t replaced = 0;
  const int row_samples = pixels.cols * pixels.channels();
  for (int y = 0; y < pixels.rows; ++y) {
    float* row = pixels.ptr<float>(y);
    for (int i = 0; i < row_samples; ++i) {
      if (std::abs(row[i]) <= kMaxSample) continue;
      row[i] = row[i] > 0 ? kMaxSample : row[i] < 0 ? -kMaxSample : 0;
      ++replaced;
    }
  }
  return replaced;
}

// Turns a picture as its orientation tag (TIFF and Exif, 1 to 8) says.
cv::Mat Upright(const cv::Mat& pixels, int orientation) {
  cv::Mat upright = pixels;
  if (orientation >= 5) cv::transpose(pixels, upright);  // 5 to 8 have rows and columns swapped
  switch (orientation) {
    case 2:
    case 6:
      cv::flip(upright, upright, 1);
      break;
    case 3:
    case 7:
      cv::flip(upright, upright, -1);
      break;
    case 4:
    case 8:
      cv::flip(upright, upright, 0);
      break;
    default:
      break;
  }
  return upright;
}

// Not pictures, or nothing that anyone means by one.
const std::vector<std::string> kNotPictures = {"ffmpeg", "null", "openvdb", "term", "zfile"};

}  // namespace

const std::vector<std::string>& PictureExtensions() {
  static const std::vector<std::string> extensions = [] {
    // "openexr:exr,sxr,mxr;tiff:tif,tiff;..."
    std::vector<std::string> found;
    std::istringstream formats(OIIO::get_string_attribute("extension_list"));
    for (std::string format; std::getline(formats, format, ';');) {
      const size_t colon = format.find(':');
      if (std::ranges::count(kNotPictures, format.substr(0, colon)) > 0) continue;
      std::istringstream names(format.substr(colon + 1));
      for (std::string name; std::getline(names, name, ',');) found.push_back(name);
    }
    return found;
  }();
  return extensions;
}

Picture ReadSamples(const fs::path& path, std::span<const uint8_t> bytes) {
  const Input input = Open(path, bytes);
  const OIIO::ImageSpec& spec = input->spec();
  const std::vector<int> picked = ColourChannels(path, spec);
  Picture picture;
  picture.pixels = ReadPicked(path, *input, picked);
  if (picture.pixels.depth() == CV_32F) picture.replaced = ReplaceNonFinite(picture.pixels);
  picture.pixels = Upright(picture.pixels, spec.get_int_attribute("Orientation", 1));
  picture.linear = spec.format.is_floating_point() || input->format_name() == std::string("openexr");
  picture.alpha_dropped = spec.alpha_channel >= 0 && std::ranges::count(picked, spec.alpha_channel) == 0;
  return picture;
}

Picture ReadImage(const fs::path& path, std::span<const uint8_t> bytes) {
  Picture picture = ReadSamples(path, bytes);
  if (picture.pixels.depth() != CV_32F) picture.pixels = FromSamples(picture.pixels);
  return picture;
}

cv::Mat StoredSamples(const fs::path& path, std::span<const uint8_t> bytes) {
  const Input input = Open(path, bytes);
  const OIIO::ImageSpec& spec = input->spec();
  const int depth = spec.format == OIIO::TypeUInt8    ? CV_8U
                    : spec.format == OIIO::TypeUInt16 ? CV_16U
                    : spec.format == OIIO::TypeHalf   ? CV_16F
                    : spec.format == OIIO::TypeFloat  ? CV_32F
                                                      : -1;
  if (depth < 0 || !spec.channelformats.empty() || spec.nchannels > CV_CN_MAX)
    Fail(path, "a kind of picture that no data set has");
  try {
    const cv::Mat samples = NewPicture(spec.height, spec.width, CV_MAKETYPE(depth, spec.nchannels));
    const bool read = input->read_image(0, 0, 0, spec.nchannels, spec.format, samples.data);
    const std::string message = input->geterror();
    if (!read || !message.empty())
      Fail(path, "damaged picture (" + (message.empty() ? "cut off" : message) + ")");
    return samples;
  } catch (const cv::Exception& error) {
    Fail(path, "can't be held in memory (" + error.err + ")");
  }
}

cv::Mat ReadChannels(const fs::path& path, std::span<const std::string> names,
                     std::span<const uint8_t> bytes) {
  const Input input = Open(path, bytes);
  std::vector<int> picked;
  for (const std::string& name : names) {
    picked.push_back(input->spec().channelindex(name));
    if (picked.back() < 0) return {};
  }
  return FromSamples(ReadPicked(path, *input, picked));
}

}  // namespace shimmer::dataset
