#include <OpenImageIO/imageio.h>

#include "sim/dataset/image_io.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

std::vector<cv::Mat> Decode(const std::filesystem::path& path) {
  std::vector<cv::Mat> frames;
  const auto input = OIIO::ImageInput::open(path.string());
  EXPECT_TRUE(input);
  for (int i = 0; input && input->seek_subimage(i, 0); ++i) {
    const OIIO::ImageSpec& spec = input->spec();
    cv::Mat frame(spec.height, spec.width, CV_8UC3);
    EXPECT_TRUE(input->read_image(i, 0, 0, 3, OIIO::TypeUInt8, frame.data)) << input->geterror();
    frames.push_back(frame);
  }
  return frames;
}

cv::Mat Bytes(const cv::Mat& image) { return ToSamples(image, {FileFormat::kPng, 8}); }

TEST(Gif, FewColoursComeBackExactly) {
  const TempFolder folder;
  // 16 colours far apart (51 levels and more): the dither of 8 levels moves none to a neighbour.
  std::vector<cv::Mat> frames;
  for (int t = 0; t < 3; ++t) {
    cv::Mat frame(23, 37, CV_8UC3);
    for (int y = 0; y < frame.rows; ++y)
      for (int x = 0; x < frame.cols; ++x)
        frame.at<cv::Vec3b>(y, x) = cv::Vec3b((x + t) % 4 * 85, y % 4 * 85, 128);
    frames.push_back(frame);
  }
  const auto path = folder.Put("few.gif", EncodeGif(frames, 70));
  const std::vector<cv::Mat> back = Decode(path);
  ASSERT_EQ(back.size(), 3u);
  for (int t = 0; t < 3; ++t) EXPECT_TRUE(SameBits(back[t], frames[t])) << t;
  const auto input = OIIO::ImageInput::open(path.string());
  EXPECT_NEAR(input->spec().get_float_attribute("FramesPerSecond"), 1000 / 70.,
              1e-3);  // a fraction read as float
}

TEST(Gif, NoiseFillsAndRestartsTheCompressionTable) {
  const TempFolder folder;
  // 200,000 pixels of noise pass the 4096 codes many times. 256 colours for noise in a cube of 256 levels are
  // about 256 / 256^(1/3) = 40 levels apart, so none is more than 40 away along an axis, dither included.
  const std::vector<cv::Mat> frames = {Bytes(RandomImage({500, 400}, 3, 1))};
  const std::vector<cv::Mat> back = Decode(folder.Put("noise.gif", EncodeGif(frames, 100)));
  ASSERT_EQ(back.size(), 1u);
  cv::Mat difference;
  cv::absdiff(back[0], frames[0], difference);
  double largest = 0;
  cv::minMaxLoc(difference.reshape(1), nullptr, &largest);
  EXPECT_LE(largest, 64);  // cells at the cube's faces are larger than the mean one
  EXPECT_LE(cv::mean(difference)[0], 20);
}

TEST(Gif, WhatStandsStillStaysStill) {
  const TempFolder folder;
  // A ramp needs more than 256 colours together with the rest; only the right half moves.
  std::vector<cv::Mat> frames;
  for (uint32_t t = 0; t < 3; ++t) {
    cv::Mat frame = Bytes(RandomImage({64, 32}, 3, t));
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        frame.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<uint8_t>(x * 8), static_cast<uint8_t>(y * 8), 90);
    frames.push_back(frame);
  }
  const std::vector<cv::Mat> back = Decode(folder.Put("still.gif", EncodeGif(frames, 70)));
  ASSERT_EQ(back.size(), 3u);
  const cv::Rect left(0, 0, 32, 32);
  EXPECT_TRUE(SameBits(back[0](left).clone(), back[1](left).clone()));
  EXPECT_TRUE(SameBits(back[0](left).clone(), back[2](left).clone()));
}

TEST(Gif, TinyAndOneColour) {
  const TempFolder folder;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1)}) {
    const std::vector<cv::Mat> frames(2, cv::Mat(size, CV_8UC3, cv::Scalar(10, 200, 30)));
    const std::vector<cv::Mat> back = Decode(folder.Put("tiny.gif", EncodeGif(frames, 10)));
    ASSERT_EQ(back.size(), 2u);
    EXPECT_TRUE(SameBits(back[1], frames[1])) << size;
  }
}

TEST(Gif, TheSameBytesAgain) {
  const std::vector<cv::Mat> frames = {Bytes(RandomImage({30, 20}, 3, 1)),
                                       Bytes(RandomImage({30, 20}, 3, 2))};
  EXPECT_EQ(EncodeGif(frames, 70), EncodeGif(frames, 70));
}

TEST(Gif, WrongArguments) {
  const cv::Mat frame(2, 3, CV_8UC3, cv::Scalar::all(0));
  const std::vector<cv::Mat> none, sizes = {frame, cv::Mat(3, 2, CV_8UC3)}, grey = {cv::Mat(2, 2, CV_8UC1)},
                                   one = {frame};
  EXPECT_THROW(EncodeGif(none, 70), std::invalid_argument);
  EXPECT_THROW(EncodeGif(sizes, 70), std::invalid_argument);
  EXPECT_THROW(EncodeGif(grey, 70), std::invalid_argument);
  EXPECT_THROW(EncodeGif(one, 0), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::dataset
