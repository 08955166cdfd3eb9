// Sources that can't be used: each is one clear error with its path, and none is taken for whole.
#include <OpenImageIO/imageio.h>

#include "sim/dataset/image_io.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

std::string ErrorOfReading(const std::filesystem::path& path) {
  return ErrorOf<std::runtime_error>([&] { ReadImage(path); });
}

std::vector<uint8_t> FileOf(const TempFolder& folder, const std::string& extension) {
  // Noise on a ramp of few levels: EXR stores what doesn't compress as it is, without a checksum.
  cv::Mat image = RandomImage({97, 61}, 3, 1, 0, 0.05f);
  for (int y = 0; y < image.rows; ++y) image.row(y) += cv::Scalar::all(y / 64.);
  image = Quantise(image, {FileFormat::kPng, 8});
  if (extension == "png") return EncodePng(image, 8);
  if (extension == "exr") return EncodeImage(image, {FileFormat::kExr, 16});
  const std::filesystem::path path = folder / ("whole." + extension);
  const cv::Mat samples = ToSamples(image, {FileFormat::kPng, 8});
  auto output = OIIO::ImageOutput::create(path.string());
  EXPECT_TRUE(output && output->open(path.string(), OIIO::ImageSpec(97, 61, 3, OIIO::TypeUInt8)) &&
              output->write_image(OIIO::TypeUInt8, samples.data) && output->close());
  return ReadFile(path);
}

TEST(BadImage, CutOff) {
  const TempFolder folder;
  for (const std::string extension : {"png", "jpg", "exr", "tif", "bmp", "webp"}) {
    const std::vector<uint8_t> whole = FileOf(folder, extension);
    EXPECT_NO_THROW(ReadImage(folder.Put("whole." + extension, whole))) << extension;
    for (const int percent : {1, 50, 95}) {
      const auto path = folder.Put("cut." + extension, std::span(whole).first(whole.size() * percent / 100));
      const std::string error = ErrorOfReading(path);
      EXPECT_TRUE(Contains(error, path.string())) << extension << " " << percent << ": " << error;
      EXPECT_FALSE(Contains(error, "\n")) << error;
    }
  }
}

TEST(BadImage, OnlyTheEndIsMissing) {
  const TempFolder folder;
  for (const std::string extension : {"png", "jpg"}) {
    const std::vector<uint8_t> whole = FileOf(folder, extension);
    const auto path = folder.Put("cut." + extension, std::span(whole).first(whole.size() - 1));
    EXPECT_NE(ErrorOfReading(path), "") << extension;
  }
}

TEST(BadImage, FlippedBitsOfPngAndExr) {
  const TempFolder folder;
  for (const std::string extension : {"png", "exr"}) {
    const std::vector<uint8_t> whole = FileOf(folder, extension);
    const cv::Mat pixels = ReadImage(folder.Put("whole." + extension, whole)).pixels;
    for (size_t at = 8; at < whole.size(); at += whole.size() / 50) {
      std::vector<uint8_t> flipped = whole;
      flipped[at] ^= 0x10;
      const auto path = folder.Put("flipped." + extension, flipped);
      // Refused, or the bit was in something that is no pixel (an attribute).
      cv::Mat read;
      const bool refused = !ErrorOf<std::runtime_error>([&] { read = ReadImage(path).pixels; }).empty();
      EXPECT_TRUE(refused || SameBits(read, pixels)) << extension << " at " << at;
    }
  }
}

TEST(BadImage, NoPicture) {
  const TempFolder folder;
  EXPECT_TRUE(Contains(ErrorOfReading(folder / "no.png"), "no such file"));
  EXPECT_TRUE(Contains(ErrorOfReading(folder.path()), "is a folder"));
  EXPECT_TRUE(Contains(ErrorOfReading(folder.Put("empty.png", "")), "empty"));
  EXPECT_TRUE(Contains(ErrorOfReading(folder.Put("text.jpg", "This is no picture.\n")), "not a picture"));
  EXPECT_TRUE(Contains(ErrorOfReading(folder.Put("text", "Nor is this.\n")), "not a picture"));
  EXPECT_TRUE(Contains(ErrorOfReading("/dev/null"), "not a regular file"));
}

TEST(BadImage, AWrongExtensionIsNoReasonToRefuse) {
  const TempFolder folder;
  const cv::Mat image = RandomImage({5, 4}, 3, 1);
  const Picture picture = ReadImage(folder.Put("really_png.jpg", EncodePng(image, 16)));
  EXPECT_TRUE(SameBits(picture.pixels, Quantise(image, {FileFormat::kPng, 16})));
}

TEST(BadImage, TooLargeIsRefusedBeforeMemoryIsAskedFor) {
  const TempFolder folder;
  // 40000 x 2 for PNG and TIFF; a BMP header that promises 2e9 x 2e9 and has nothing behind it.
  const std::string error = ErrorOfReading(folder.Put(
      "wide.png", EncodePng(cv::Mat::zeros(2, kMaxSide_px + 1, CV_32F), 8, PngWriter::kOpenImageIo)));
  EXPECT_TRUE(Contains(error, "32769 x 2")) << error;
  EXPECT_NO_THROW(ReadImage(folder.Put("just.png", EncodePng(cv::Mat::zeros(1, kMaxSide_px, CV_32F), 8))));
  std::vector<uint8_t> bmp = FileOf(folder, "bmp");
  for (const size_t at : {18, 22}) bmp[at] = 0, bmp[at + 1] = 0x94, bmp[at + 2] = 0x35, bmp[at + 3] = 0x77;
  EXPECT_NE(ErrorOfReading(folder.Put("huge.bmp", bmp)), "");
}

}  // namespace
}  // namespace shimmer::dataset
