#include "sim/dataset/frame_reader.h"

#include <opencv2/videoio.hpp>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

TEST(FrameReader, AStill) {
  const TempFolder folder;
  const cv::Mat image = RandomImage({5, 4}, 3, 1);
  const auto reader = OpenStill(folder.Put("x.png", EncodePng(image, 8)));
  EXPECT_EQ(reader->count(), 1);
  EXPECT_TRUE(SameBits(reader->Read(0).pixels, ToSamples(image, {})));
  EXPECT_THROW(reader->Read(1), std::invalid_argument);
  EXPECT_THROW(reader->Read(-1), std::invalid_argument);
  EXPECT_THROW(OpenStill(folder / "no.png"), std::runtime_error);
}

TEST(FrameReader, ASequence) {
  const TempFolder folder;
  std::vector<cv::Mat> frames;
  for (int i = 0; i < 3; ++i) {
    frames.push_back(RandomImage({5, 4}, 1, i));
    folder.Put("in" + std::to_string(8 + i) + ".png", EncodePng(frames[i], 16));
  }
  for (const auto& sequence : {folder / "in%d.png", folder.path()}) {
    const auto reader = OpenSequence(sequence);
    ASSERT_EQ(reader->count(), 3);
    for (const int i : {2, 0, 1})
      EXPECT_TRUE(SameBits(reader->Read(i).pixels, ToSamples(frames[i], {FileFormat::kPng, 16}))) << i;
    EXPECT_THROW(reader->Read(3), std::invalid_argument);
  }
}

TEST(FrameReader, ReadsThroughACache) {
  const TempFolder folder;
  for (int i = 0; i < 3; ++i) folder.Put(std::to_string(i) + ".png", EncodePng(RandomImage({5, 4}, 3, i), 8));
  PictureCache cache(1 << 20);
  for (int run = 0; run < 2; ++run) {
    EXPECT_TRUE(SameBits(OpenStill(folder / "1.png", &cache)->Read(0).pixels,
                         OpenSequence(folder.path(), &cache)->Read(1).pixels));
    EXPECT_THROW(OpenStill(folder / "no.png", &cache), std::runtime_error);
  }
  EXPECT_EQ(cache.statistics().misses, 1);
  EXPECT_EQ(cache.statistics().hits, 3);
}

TEST(FrameReader, FramesOfASequenceMayHaveOtherBits) {
  const TempFolder folder;
  folder.Put("0.png", EncodePng(RandomImage({5, 4}, 3, 1), 8));
  folder.Put("1.png", EncodePng(RandomImage({5, 4}, 3, 1), 16));
  const auto reader = OpenSequence(folder.path());
  EXPECT_EQ(reader->Read(0).pixels.type(), CV_8UC3);
  EXPECT_EQ(reader->Read(1).pixels.type(), CV_16UC3);
}

TEST(FrameReader, FramesOfASequenceThatDontFit) {
  const TempFolder folder;
  folder.Put("0.png", EncodePng(RandomImage({5, 4}, 3, 1), 8));
  folder.Put("1.png", EncodePng(RandomImage({4, 5}, 3, 1), 8));
  folder.Put("2.png", EncodePng(RandomImage({5, 4}, 1, 1), 8));
  folder.Put("3.png", "damaged");
  const auto reader = OpenSequence(folder / "%d.png");
  EXPECT_NO_THROW(reader->Read(0));
  for (const int i : {1, 2}) {
    const std::string error = ErrorOf<std::runtime_error>([&] { reader->Read(i); });
    EXPECT_TRUE(Contains(error, std::to_string(i) + ".png: another size or number of channels")) << error;
  }
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { reader->Read(3); }), "3.png"));
}

class VideoFile : public ::testing::Test {
 protected:
  static constexpr int kFrames = 12;

  // Frame t is one colour: red 20 t, green 200 - 10 t, blue 60 (coded as BGR).
  static cv::Scalar Colour(int t) { return {20. * t, 200 - 10. * t, 60}; }

  void SetUp() override {
    path_ = folder_ / "12:30 colours.avi";
    cv::VideoWriter writer(path_.string(), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           25, {48, 32});
    if (!writer.isOpened()) GTEST_SKIP() << "this OpenCV can't write Motion JPEG";
    for (int t = 0; t < kFrames; ++t) {
      const cv::Scalar colour = Colour(t);
      writer.write(cv::Mat(32, 48, CV_8UC3, cv::Scalar(colour[2], colour[1], colour[0])));
    }
  }

  static void ExpectFrame(const Picture& picture, int t) {
    ASSERT_EQ(picture.pixels.type(), CV_8UC3);
    EXPECT_EQ(picture.pixels.size(), cv::Size(48, 32));
    EXPECT_FALSE(picture.linear);
    const cv::Scalar mean = cv::mean(picture.pixels);
    // JPEG of one colour: rounding to 8 bits in two colour spaces, and frames are 20 levels apart.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], Colour(t)[c], 4) << "frame " << t << ", channel " << c;
  }

  TempFolder folder_;
  std::filesystem::path path_;
};

TEST_F(VideoFile, FramesInAnyOrder) {
  const auto reader = OpenVideo(path_);
  EXPECT_EQ(reader->count(), kFrames);
  EXPECT_EQ(reader->remark(), "");
  for (const int t : {0, 1, 2, 7, 7, 3, 11, 0}) ExpectFrame(reader->Read(t), t);
  EXPECT_THROW(reader->Read(kFrames), std::invalid_argument);
}

TEST_F(VideoFile, AKnownCountIsTakenAsItIs) {
  const auto reader = OpenVideo(path_, kFrames);
  ExpectFrame(reader->Read(11), 11);
  const auto wrong = OpenVideo(path_, kFrames + 5);
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { wrong->Read(kFrames); }), "ends before frame 12"));
}

TEST_F(VideoFile, NobodyWaitsForItWhoHasAskedToStop) {
  std::atomic<bool> stop{false};
  const auto reader = OpenVideo(path_, {}, stop), known = OpenVideo(path_, kFrames, stop);
  stop = true;
  EXPECT_THROW(reader->count(), Interrupted);
  EXPECT_THROW(known->Read(5), Interrupted);
  stop = false;
  ExpectFrame(known->Read(5), 5);
}

TEST_F(VideoFile, CutOffItHasTheFramesThatDecode) {
  const std::vector<uint8_t> whole = ReadFile(path_);
  const auto reader = OpenVideo(folder_.Put("cut.avi", std::span(whole).first(whole.size() / 2)));
  EXPECT_GT(reader->count(), 0);
  EXPECT_LT(reader->count(), kFrames);
  EXPECT_TRUE(Contains(reader->remark(), "promises 12 frames")) << reader->remark();
  ExpectFrame(reader->Read(0), 0);
}

TEST_F(VideoFile, NoVideo) {
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { OpenVideo(folder_ / "no.avi"); }), "no such file"));
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { OpenVideo(folder_.Put("0.avi", "")); }), "empty"));
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { OpenVideo(folder_.Put("t.avi", "no video")); }),
                       "not a video"));
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { OpenVideo(folder_.path()); }), "is a folder"));
}

}  // namespace
}  // namespace shimmer::dataset
