#include "restore/app/frame_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/dataset/image_io.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::restore::app {
namespace {

using dataset::TempFolder;
using testing::HasSubstr;

void PutFrame(const TempFolder& folder, const std::string& name, double grey) {
  folder.Put(name, dataset::EncodePng(cv::Mat(6, 8, CV_8UC1, cv::Scalar(grey)), 8));
}

TEST(FrameSource, IsAPictureAFolderANumberedNameOrAVideo) {
  const TempFolder folder;
  PutFrame(folder, "clip/7.png", 7);
  PutFrame(folder, "clip/8.png", 8);
  PutFrame(folder, "one.PNG", 1);
  folder.Put("ramp.bin", "YUV4MPEG2 W8 H6 F25:1 Ip A1:1 C420\nFRAME\n" + std::string(48, 'a') +
                             std::string(24, '\x80') + "FRAME\n" + std::string(48, 'b') +
                             std::string(24, '\x80'));
  EXPECT_EQ(OpenFrames(folder / "one.PNG")->count(), 1);
  EXPECT_EQ(OpenFrames(folder / "clip")->count(), 2);
  EXPECT_EQ(OpenFrames(folder / "clip/%d.png")->Read(1).pixels.at<uint8_t>(0, 0), 8);
  EXPECT_EQ(OpenFrames(folder / "ramp.bin")->count(), 2);
  EXPECT_EQ(OpenFrames(folder / "ramp.bin")->Read(0).pixels.size(), cv::Size(8, 6));
}

TEST(FrameSource, WhatIsNotThereIsNamed) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "empty");
  folder.Put("text.mp4", "no video");
  EXPECT_THAT(dataset::ErrorOf<std::runtime_error>([&] { OpenFrames(folder / "absent.png"); }),
              HasSubstr("absent.png: is not there, must be a picture, a folder"));
  EXPECT_THAT(dataset::ErrorOf<std::runtime_error>([&] { OpenFrames(folder / "empty"); }),
              HasSubstr("empty: no pictures"));
  EXPECT_THAT(dataset::ErrorOf<std::runtime_error>([&] { OpenFrames(folder / "%d.png"); }),
              HasSubstr("no frame of this name"));
  EXPECT_THAT(dataset::ErrorOf<std::runtime_error>([&] { OpenFrames(folder / "text.mp4"); }),
              HasSubstr("text.mp4: not a video"));
}

}  // namespace
}  // namespace shimmer::restore::app
