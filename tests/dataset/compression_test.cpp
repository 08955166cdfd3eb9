#include "sim/dataset/compression.h"

#include "sim/dataset/image_io.h"
#include "tests/dataset/compression_frames.h"

namespace shimmer::dataset {
namespace {

// Steps of 1 in every coefficient: rounding of these and of the pixels is a level each. Colour is rounded
// once more, and interpolated.
TEST(ThroughJpeg, TheBestQualityIsNearTheFrame) {
  const cv::Mat grey = PngPicture(Content::kPhotograph, {200, 150}, CV_8UC1);
  EXPECT_LE(MaxError(ThroughJpeg(grey, 100), grey), 2);
  const cv::Mat colour = Soft({200, 150}, CV_8UC3);
  EXPECT_LT(MeanError(ThroughJpeg(colour, 100), colour), 1);
  EXPECT_LE(MaxError(ThroughJpeg(colour, 100), colour), 4);
}

TEST(ThroughJpeg, TheErrorFallsWithQuality) {
  for (const int type : kTypes) {
    const cv::Mat frame = PngPicture(Content::kPhotograph, {200, 150}, type);
    double worse = 256;
    for (const int quality : {1, 5, 20, 50, 80, 95, 100}) {
      const double error = MeanError(ThroughJpeg(frame, quality), frame);
      EXPECT_LT(error, worse) << NameOf(frame) << " quality " << quality;
      worse = error;
    }
  }
}

TEST(ThroughJpeg, AnySize) {
  for (const int type : kTypes)
    for (const cv::Size size : kSizes) {
      const cv::Mat frame = Soft(size, type), through = ThroughJpeg(frame, 95);
      ASSERT_EQ(through.type(), type) << NameOf(frame);
      ASSERT_EQ(through.size(), size) << NameOf(frame);
      EXPECT_LT(MeanError(through, frame), 3) << NameOf(frame);
    }
}

// A constant is one coefficient a block: half its step, 1/8 of a level each, and two roundings.
TEST(ThroughJpeg, AColourAloneSurvives) {
  ForEachColour([](const cv::Mat& frame) { EXPECT_LE(MaxError(ThroughJpeg(frame, 90), frame), 2); });
}

// The two colours differ by 140, 71 and 0: halfway between them each is off by 35 on average.
TEST(ThroughJpeg, ColourIsOneForTwoColumns) {
  const cv::Mat stripes = Stripes();
  EXPECT_NEAR(MeanError(ThroughJpeg(stripes, 100), stripes), 35, 5);
}

TEST(ThroughJpeg, TheSameAgainAndFromWithinALargerPicture) {
  for (const int type : kTypes) {
    const cv::Mat part = PngPicture(Content::kPhotograph, {90, 70}, type)(cv::Rect(3, 5, 61, 47));
    EXPECT_TRUE(SameBits(ThroughJpeg(part, 60), ThroughJpeg(part.clone(), 60)));
  }
}

TEST(ThroughJpeg, WrongArguments) {
  const auto error_of = [](const cv::Mat& frame, int quality) {
    return ErrorOf<std::invalid_argument>([&] { ThroughJpeg(frame, quality); });
  };
  const cv::Mat frame(4, 4, CV_8UC3, cv::Scalar::all(0));
  EXPECT_EQ(error_of(frame, 0), "quality = 0, must be in [1, 100]");
  EXPECT_EQ(error_of(frame, 101), "quality = 101, must be in [1, 100]");
  EXPECT_EQ(error_of(cv::Mat(4, 4, CV_32FC3), 90), "a JPEG of CV_32FC3, must be CV_8UC1 or CV_8UC3");
  EXPECT_EQ(error_of(cv::Mat(4, 4, CV_8UC2), 90), "a JPEG of CV_8UC2, must be CV_8UC1 or CV_8UC3");
  EXPECT_EQ(error_of(cv::Mat(), 90), "a JPEG of 0x0 px, must be 1 to 32768 each way");
  EXPECT_EQ(error_of(cv::Mat(1, kMaxSide_px + 1, CV_8UC1), 90),
            "a JPEG of 32769x1 px, must be 1 to 32768 each way");
}

TEST(Compression, NothingIsPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (const int type : kTypes)
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(65, 49)}) {
      ThroughJpeg(Soft(size, type), 1);
      for (const double crf : {0, 23, 51}) ClipThroughH264({Soft(size, type), Soft(size, type)}, crf);
    }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace shimmer::dataset
