#include "sim/dataset/compression.h"

extern "C" {
#include <libavutil/cpu.h>
}

#include <limits>
#include <thread>

#include "tests/dataset/compression_frames.h"

namespace shimmer::dataset {
namespace {

// Nothing is lost of grey, whatever the frame. RGB loses by its conversion: rounding to 219 levels of luma
// and 224 of colour moves a channel by up to 0.6 + 1.1 (blue: 1.86 * 0.57), and back to 8 bits by 0.5.
TEST(H264Stream, TheBestQualityIsNearTheFrame) {
  for (const double crf : {0.0, 0.9})
    for (const Content content : kContents) {
      const cv::Mat grey = PngPicture(content, {64, 48}, CV_8UC1);
      EXPECT_TRUE(SameBits(ThroughH264(grey, crf), grey)) << crf;
    }
  const auto clip = Clip({61, 47}, CV_8UC1, 4);
  EXPECT_TRUE(SameFrames(ClipThroughH264(clip, 0), clip));
  const cv::Mat colour = Soft({200, 150}, CV_8UC3);
  EXPECT_LT(MeanError(ThroughH264(colour, 0), colour), 1);
  EXPECT_LE(MaxError(ThroughH264(colour, 0), colour), 4);
}

TEST(H264Stream, TheErrorFallsWithQuality) {
  for (const int type : kTypes) {
    const auto clip = Clip({200, 150}, type, 3);
    double worse = 256;
    for (const double crf : {51, 40, 30, 22, 14, 5}) {
      const auto through = ClipThroughH264(clip, crf);
      double error = 0;
      for (size_t i = 0; i < clip.size(); ++i) error += MeanError(through[i], clip[i]) / clip.size();
      EXPECT_LT(error, worse) << NameOf(clip[0]) << " crf " << crf;
      worse = error;
    }
  }
}

TEST(H264Stream, AnySize) {
  for (const int type : kTypes)
    for (const cv::Size size : kSizes) {
      const cv::Mat frame = Soft(size, type);
      H264Stream stream(size, frame.channels(), 10);
      for (int i = 0; i < 3; ++i) {
        const cv::Mat through = stream.Through(frame);
        ASSERT_EQ(through.type(), type) << NameOf(frame);
        ASSERT_EQ(through.size(), size) << NameOf(frame);
        EXPECT_LT(MeanError(through, frame), 3) << NameOf(frame);
      }
    }
}

TEST(H264Stream, TheLongestSides) {
  for (const cv::Size size : {cv::Size(kMaxH264Side_px, 1), cv::Size(1, kMaxH264Side_px)}) {
    const cv::Mat frame = Soft(size, CV_8UC1);
    EXPECT_TRUE(SameBits(ThroughH264(frame, 0), frame));
  }
}

// Beyond crf 40 a level of luma's coefficients is worth more than that.
TEST(H264Stream, AColourAloneSurvives) {
  for (const double crf : {1, 23, 40})
    ForEachColour(
        [&](const cv::Mat& frame) { EXPECT_LE(MaxError(ThroughH264(frame, crf), frame), 3) << crf; });
}

TEST(H264Stream, ColourIsOneForTwoColumns) {
  const cv::Mat stripes = Stripes();
  EXPECT_NEAR(MeanError(ThroughH264(stripes, 0), stripes), 35, 5);
}

// A shift of the colour by half a pixel, between one conversion and the other, would be seen as more than a
// level: of two mirrored frames the one is then shifted the other way.
TEST(H264Stream, ColourStaysInItsPlace) {
  const cv::Mat frame = Soft({64, 48}, CV_8UC3);
  for (const int axis : {0, 1}) {
    cv::Mat mirrored, back;
    cv::flip(frame, mirrored, axis);
    cv::flip(ThroughH264(mirrored, 0), back, axis);
    EXPECT_LT(MeanError(ThroughH264(frame, 0), back), 0.1) << axis;
  }
}

// Each frame of its own shade, past a key frame: none comes late.
TEST(H264Stream, GivesBackTheFrameThatItGot) {
  for (const int type : kTypes) {
    H264Stream stream({32, 32}, CV_MAT_CN(type), 20);
    for (int i = 0; i < 120; ++i) {
      const cv::Mat frame(32, 32, type, cv::Scalar::all(20 + 37 * i % 211));
      ASSERT_LE(MaxError(stream.Through(frame), frame), 3) << i;
    }
  }
}

// What the second frame adds is what the first one lacked, if anything.
TEST(H264Stream, AStaticSceneStays) {
  for (const int type : kTypes)
    for (const double crf : {1, 18, 28, 40}) {
      const cv::Mat frame = PngPicture(Content::kPhotograph, {200, 150}, type);
      const auto through = ClipThroughH264({frame, frame}, crf);
      const double lacking = MeanError(through[0], frame);
      EXPECT_LT(MeanError(through[1], through[0]), lacking) << NameOf(frame) << " crf " << crf;
      EXPECT_LE(MeanError(through[1], frame), lacking + 0.1) << NameOf(frame) << " crf " << crf;
    }
}

// The border that is repeated is the part's, not what lies beside it.
TEST(H264Stream, FromWithinALargerPicture) {
  for (const int type : kTypes)
    for (const cv::Size size : {cv::Size(61, 47), cv::Size(5, 3)}) {
      const cv::Mat part = PngPicture(Content::kNoise, {90, 70}, type)(cv::Rect({3, 5}, size));
      EXPECT_TRUE(SameBits(ThroughH264(part, 25), ThroughH264(part.clone(), 25))) << NameOf(part);
    }
}

TEST(H264Stream, AWrongFrameIsNotInTheStream) {
  const auto clip = Clip({40, 30}, CV_8UC3, 2);
  H264Stream stream({40, 30}, 3, 25);
  const cv::Mat first = stream.Through(clip[0]);
  EXPECT_THROW(stream.Through(clip[1].rowRange(0, 29)), std::invalid_argument);
  EXPECT_TRUE(SameFrames({first, stream.Through(clip[1])}, ClipThroughH264(clip, 25)));
}

TEST(H264Stream, TheSameBesideOtherThreads) {
  for (const int type : kTypes) {
    const auto clip = Clip({101, 75}, type, 6);
    const auto alone = ClipThroughH264(clip, 25);
    EXPECT_TRUE(SameFrames(ClipThroughH264(clip, 25), alone));
    std::vector<std::vector<cv::Mat>> through(4);
    std::vector<std::thread> threads;
    for (auto& frames : through) threads.emplace_back([&] { frames = ClipThroughH264(clip, 25); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& frames : through) EXPECT_TRUE(SameFrames(frames, alone));
  }
}

// FFmpeg's part alone: x264 can't be told from here what the CPU lacks.
TEST(H264Stream, TheSameOnAnyCpu) {
  const auto clip = Clip({101, 75}, CV_8UC3, 3);
  const auto native = ClipThroughH264(clip, 20);
  for (const int flags : {0, AV_CPU_FLAG_MMX | AV_CPU_FLAG_MMXEXT | AV_CPU_FLAG_SSE | AV_CPU_FLAG_SSE2}) {
    av_force_cpu_flags(flags);
    EXPECT_TRUE(SameFrames(ClipThroughH264(clip, 20), native)) << flags;
  }
  av_force_cpu_flags(-1);
}

TEST(H264Stream, WrongArguments) {
  const auto error_of = [](cv::Size size, int channels, double crf) {
    return ErrorOf<std::invalid_argument>([&] { H264Stream(size, channels, crf); });
  };
  EXPECT_EQ(error_of({0, 4}, 1, 20), "size = 0x4 px, must be 1 to 16384 each way");
  EXPECT_EQ(error_of({4, -1}, 1, 20), "size = 4x-1 px, must be 1 to 16384 each way");
  EXPECT_EQ(error_of({16385, 4}, 1, 20), "size = 16385x4 px, must be 1 to 16384 each way");
  EXPECT_EQ(error_of({4, 4}, 2, 20), "channels = 2, must be 1 or 3");
  EXPECT_EQ(error_of({4, 4}, 3, -0.5), "crf = -0.500000, must be in [0, 51]");
  EXPECT_EQ(error_of({4, 4}, 3, 51.5), "crf = 51.500000, must be in [0, 51]");
  EXPECT_EQ(error_of({4, 4}, 3, std::numeric_limits<double>::quiet_NaN()), "crf = nan, must be in [0, 51]");
  H264Stream stream({6, 4}, 3, 20);
  const auto error_with = [&](const cv::Mat& frame) {
    return ErrorOf<std::invalid_argument>([&] { stream.Through(frame); });
  };
  EXPECT_EQ(error_with(cv::Mat(4, 6, CV_8UC1)), "frame = CV_8UC1 6x4 px, must be CV_8UC3 6x4 px");
  EXPECT_EQ(error_with(cv::Mat(6, 4, CV_8UC3)), "frame = CV_8UC3 4x6 px, must be CV_8UC3 6x4 px");
  EXPECT_EQ(error_with(cv::Mat()), "frame = CV_8UC1 0x0 px, must be CV_8UC3 6x4 px");
}

}  // namespace
}  // namespace shimmer::dataset
