#include "sim/dataset/pixel_hash.h"

#include "sim/dataset/sha256.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

TEST(PixelHash, IsTheHashOfTheStatedForm) {
  const cv::Mat image = (cv::Mat_<float>(1, 2) << 0.f, 1.f);
  const auto hash_of = [](std::string head, std::vector<uint8_t> samples) {
    head.append(samples.begin(), samples.end());
    return Sha256Hex(AsBytes(head));
  };
  EXPECT_EQ(PixelHash(image, {FileFormat::kPng, 8}), hash_of("2 1 1 uint8\n", {0, 255}));
  EXPECT_EQ(PixelHash(image, {FileFormat::kPng, 16}), hash_of("2 1 1 uint16\n", {0, 0, 255, 255}));
  EXPECT_EQ(PixelHash(image, {FileFormat::kExr, 16}), hash_of("2 1 1 float16\n", {0, 0, 0x00, 0x3c}));
  EXPECT_EQ(PixelHash(image, {FileFormat::kExr, 32}),
            hash_of("2 1 1 float32\n", {0, 0, 0, 0, 0, 0, 0x80, 0x3f}));
}

TEST(PixelHash, OfAPictureReadBackIsTheSame) {
  const TempFolder folder;
  for (const Encoding encoding : {Encoding{FileFormat::kPng, 8}, Encoding{FileFormat::kPng, 16},
                                  Encoding{FileFormat::kExr, 16}, Encoding{FileFormat::kExr, 32}}) {
    const cv::Mat image = RandomImage({7, 5}, 3, 1);
    const auto path =
        folder.Put(std::string("x.") + Extension(encoding.format), EncodeImage(image, encoding));
    EXPECT_EQ(PixelHash(ReadImage(path).pixels, encoding), PixelHash(image, encoding)) << encoding.bits;
  }
}

TEST(PixelHash, TellsShapesAndPixelsApart) {
  const Encoding encoding;
  const cv::Mat wide = cv::Mat::zeros(1, 4, CV_32F), high = cv::Mat::zeros(4, 1, CV_32F);
  cv::Mat other = wide.clone();
  other.at<float>(0, 3) = 1 / 255.f;
  EXPECT_NE(PixelHash(wide, encoding), PixelHash(high, encoding));
  EXPECT_NE(PixelHash(wide, encoding), PixelHash(other, encoding));
}

TEST(PixelHash, OfAPartOfALargerPictureIsThatOfItsCopy) {
  const cv::Mat image = RandomImage({9, 9}, 3, 1);
  const cv::Mat part = ToSamples(image, {})(cv::Rect(2, 3, 4, 5));
  EXPECT_EQ(PixelHashOfSamples(part), PixelHashOfSamples(part.clone()));
}

}  // namespace
}  // namespace shimmer::dataset
