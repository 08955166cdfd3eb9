#include "sim/dataset/png_write.h"

#include <hwy/highway.h>

#include <opencv2/imgcodecs.hpp>
#include <set>
#include <thread>

#include "sim/dataset/image_io.h"
#include "sim/dataset/png_check.h"
#include "tests/dataset/png_pictures.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

using Bytes = std::vector<uint8_t>;

int64_t MostBytesOf(const cv::Mat& samples) {
  return PngMostBytes(samples.cols, samples.rows, samples.channels(), samples.depth() == CV_8U ? 8 : 16);
}

// Grey, so that it is not about the order of channels.
bool ComesBack(const cv::Mat& grey, const Bytes& file) {
  return SameBits(cv::imdecode(file, cv::IMREAD_UNCHANGED), grey);
}

TEST(PngWrite, HasItsHeaderAndPixelsAndNothingElse) {
  const Bytes file = WritePng(PngPicture(Content::kPhotograph, {300, 258}, CV_16UC4));
  ASSERT_TRUE(LooksLikePng(file));
  std::string types;
  for (size_t at = 8; at < file.size();) {
    const size_t length =
        (size_t{file[at]} << 24) + (file[at + 1] << 16) + (file[at + 2] << 8) + file[at + 3];
    const std::string type(file.begin() + at + 4, file.begin() + at + 8);
    if (type != "IDAT" || !types.ends_with("IDAT ")) types += type + " ";
    at += 12 + length;
  }
  EXPECT_EQ(types, "IHDR IDAT IEND ");
  // Length, type, width, height, bits, colour type RGBA, the compression, the filters, not interlaced.
  const Bytes header = {0, 0, 0, 13, 'I', 'H', 'D', 'R', 0, 0, 1, 44, 0, 0, 1, 2, 16, 6, 0, 0, 0};
  EXPECT_EQ(Bytes(file.begin() + 8, file.begin() + 8 + header.size()), header);
}

TEST(PngWrite, IsWholeAndWithinItsBound) {
  ForEachPngPicture([](const cv::Mat& samples) {
    const Bytes file = WritePng(samples);
    EXPECT_FALSE(PngDamage(file)) << NameOf(samples) << *PngDamage(file);
    EXPECT_LE(static_cast<int64_t>(file.size()), MostBytesOf(samples)) << NameOf(samples);
  });
}

TEST(PngWrite, TheBoundIsTheSamplesAndLittleMore) {
  // Samples, a byte a row, 17 for each begun 65,535, and 51.
  EXPECT_EQ(PngMostBytes(1, 1, 1, 8), 1 + 1 + 17 + 51);
  EXPECT_EQ(PngMostBytes(65534 / 2, 1, 2, 8), 65534 + 1 + 17 + 51);
  EXPECT_EQ(PngMostBytes(256, 256, 1, 8), 65536 + 256 + 2 * 17 + 51);
  EXPECT_EQ(PngMostBytes(1024, 1024, 3, 8), 3145728 + 1024 + 49 * 17 + 51);
  EXPECT_EQ(PngMostBytes(32768, 32768, 4, 16), 8589934592 + 32768 + 131075 * 17 + 51);
}

// What has from 1 to 256 levels, all as likely, deflates from well to not at all; near 256 a Huffman code
// would make it larger.
TEST(PngWrite, NoiseOfAnyNumberOfLevelsIsWithinItsBound) {
  int stored = 0;
  for (const int levels : {1, 2, 3, 16, 100, 200, 230, 245, 250, 253, 254, 255, 256}) {
    cv::Mat noise(200, 700, CV_8UC1);
    cv::RNG random(levels);
    random.fill(noise, cv::RNG::UNIFORM, 0, levels);
    const Bytes file = WritePng(noise);
    EXPECT_LE(static_cast<int64_t>(file.size()), MostBytesOf(noise)) << levels;
    EXPECT_TRUE(ComesBack(noise, file)) << levels;
    stored += static_cast<int64_t>(file.size()) == MostBytesOf(noise);
  }
  EXPECT_GE(stored, 1);  // or else the other way to write was not taken at all
}

// Rows longer than what is deflated at once, and the longest and the thinnest pictures.
TEST(PngWrite, LongRows) {
  for (const cv::Size size : {cv::Size(kMaxSide_px, 1), cv::Size(1, kMaxSide_px), cv::Size(kMaxSide_px, 5)})
    for (const Content content : {Content::kPhotograph, Content::kNoise})
      for (const int type : {CV_8UC1, CV_16UC1}) {
        const cv::Mat samples = PngPicture(content, size, type);
        const Bytes file = WritePng(samples);
        EXPECT_LE(static_cast<int64_t>(file.size()), MostBytesOf(samples));
        EXPECT_TRUE(ComesBack(samples, file)) << NameOf(samples);
      }
}

// Deflated data goes out in pieces of 256 KiB. Here it ends before, at and after the end of one, byte by
// byte: noise of a little more, with more and more of its last pixels made black.
TEST(PngWrite, DataThatEndsNearTheEndOfAPiece) {
  constexpr size_t kPiece = 1 << 18, kAround = 8 + 25 + 2 * 12;
  cv::Mat noise(300, 850, CV_8UC1);
  Bytes file;
  while (file.size() <= kPiece + kAround + 100) {
    noise.create(noise.rows, noise.cols + 1, noise.type());
    cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 70);
    noise.row(noise.rows - 2) = 0;
    file = WritePng(noise);
  }
  std::set<size_t> sizes;
  for (int black = 0; file.size() > kPiece + kAround - 100; ++black) {
    ASSERT_LT(black, noise.cols);
    noise(cv::Rect(0, noise.rows - 1, black, 1)) = 0;
    file = WritePng(noise);
    ASSERT_TRUE(ComesBack(noise, file)) << file.size();
    ASSERT_FALSE(PngDamage(file)) << file.size();
    sizes.insert(file.size());
  }
  EXPECT_GT(sizes.size(), 50u);
}

TEST(PngWrite, RandomSizes) {
  std::mt19937 generator(5);
  for (int i = 0; i < 300; ++i) {
    const cv::Size size(1 + generator() % 130, 1 + generator() % 130);
    const cv::Mat samples =
        PngPicture(kContents[generator() % 4], size, generator() % 2 ? CV_8UC1 : CV_16UC1);
    const Bytes file = WritePng(samples);
    ASSERT_TRUE(ComesBack(samples, file)) << NameOf(samples);
    ASSERT_LE(static_cast<int64_t>(file.size()), MostBytesOf(samples));
  }
}

TEST(PngWrite, FromWithinALargerPicture) {
  for (const int type : kPngTypes)
    for (const Content content : {Content::kPhotograph, Content::kNoise}) {
      const cv::Mat part = PngPicture(content, {90, 70}, type)(cv::Rect(3, 5, 61, 47));
      ASSERT_FALSE(part.isContinuous());
      EXPECT_EQ(WritePng(part), WritePng(part.clone())) << NameOf(part);
    }
}

TEST(PngWrite, TheSameBytesOnEveryTarget) {
  std::vector<Bytes> first;
  int targets = 0;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    std::vector<Bytes> files;
    for (const int type : kPngTypes)
      files.push_back(WritePng(PngPicture(Content::kPhotograph, {251, 83}, type)));
    if (targets++ == 0) first = files;
    EXPECT_EQ(files, first) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 2);
}

// What a thread keeps from file to file is not seen in the next one.
TEST(PngWrite, TheSameBytesAfterOthersAndOnOtherThreads) {
  std::vector<cv::Mat> pictures;
  for (const Content content : kContents) {
    pictures.push_back(PngPicture(content, {400, 300}, CV_8UC3));
    pictures.push_back(PngPicture(content, {17, 9}, CV_16UC2));
  }
  std::vector<Bytes> alone(pictures.size());
  for (size_t i = 0; i < pictures.size(); ++i) std::thread([&] { alone[i] = WritePng(pictures[i]); }).join();
  for (int round = 0; round < 2; ++round)
    for (size_t i = 0; i < pictures.size(); ++i) EXPECT_EQ(WritePng(pictures[i]), alone[i]) << i;
  std::vector<std::thread> threads;
  for (size_t start = 0; start < 4; ++start)
    threads.emplace_back([&, start] {
      for (size_t k = 0; k < pictures.size(); ++k) {
        const size_t i = (start + k) % pictures.size();
        EXPECT_EQ(WritePng(pictures[i]), alone[i]);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(PngWrite, WrongArguments) {
  const auto error_of = [](const cv::Mat& samples) {
    return ErrorOf<std::invalid_argument>([&] { WritePng(samples); });
  };
  EXPECT_EQ(error_of(cv::Mat()), "a PNG of 0x0 px, must be 1 to 32768 each way");
  EXPECT_EQ(error_of(cv::Mat(2, 2, CV_32FC3)), "a PNG of CV_32FC3, must be CV_8U or CV_16U");
  EXPECT_EQ(error_of(cv::Mat(2, 2, CV_16SC1)), "a PNG of CV_16SC1, must be CV_8U or CV_16U");
  EXPECT_EQ(error_of(cv::Mat(2, 2, CV_8UC(5))), "a PNG of 5 channels, must be 1 to 4");
  EXPECT_EQ(error_of(cv::Mat(1, kMaxSide_px + 1, CV_8UC1)),
            "a PNG of 32769x1 px, must be 1 to 32768 each way");
  EXPECT_EQ(error_of(cv::Mat(kMaxSide_px + 1, 1, CV_8UC1)),
            "a PNG of 1x32769 px, must be 1 to 32768 each way");
  EXPECT_THROW(PngMostBytes(0, 1, 1, 8), std::invalid_argument);
  EXPECT_THROW(PngMostBytes(1, -1, 1, 8), std::invalid_argument);
  EXPECT_THROW(PngMostBytes(1, 1, 0, 8), std::invalid_argument);
  EXPECT_THROW(PngMostBytes(1, 1, 5, 8), std::invalid_argument);
  EXPECT_THROW(PngMostBytes(1, 1, 1, 32), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::dataset
