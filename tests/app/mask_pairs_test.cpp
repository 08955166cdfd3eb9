#include "sim/app/mask_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/sets.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using Indices = std::vector<size_t>;

Indices Pairs(const Words& items, const Words& masks) { return PairMasks(items, masks); }

// Sorted by their names masks would stand in another order than what they are of: '_' comes after '-' and
// '.'.
TEST(MaskPairs, GoByWhatNamesDifferIn) {
  EXPECT_EQ(Pairs({"bear-2.mp4", "bear.mp4"}, {"bear-2_mask.mp4", "bear_mask.mp4"}), (Indices{0, 1}));
  EXPECT_EQ(Pairs({"bear-2.mp4", "bear.mp4"}, {"bear_mask.mp4", "bear-2_mask.mp4"}), (Indices{1, 0}));
  EXPECT_EQ(Pairs({"frames/bear", "frames/camel", "frames/car"}, {"masks/camel", "masks/car", "masks/bear"}),
            (Indices{2, 0, 1}));
  EXPECT_EQ(Pairs({"a/in", "b/in"}, {"b/truth", "a/truth"}), (Indices{1, 0}));
  EXPECT_EQ(Pairs({"aa", "a"}, {"maa", "ma"}), (Indices{0, 1}));
  EXPECT_EQ(Pairs({"one.mp4"}, {"whatever.avi"}), Indices{0});
  EXPECT_EQ(Pairs({}, {}), Indices{});
}

TEST(MaskPairs, SayWhatIsWithoutItsLike) {
  const auto error_of = [](const Words& items, const Words& masks) {
    try {
      PairMasks(items, masks);
      return std::string("no error");
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(error_of({"a.mp4", "b.mp4"}, {"a.mp4"}), "finds 1, must find one for each of the 2");
  EXPECT_THAT(error_of({"x_bear", "x_camel"}, {"m_bear", "m_cow"}), HasSubstr("none for x_camel"));
  EXPECT_THAT(error_of({"v1", "v2", "v10"}, {"m01", "m02", "m10"}), HasSubstr("none for v1"));
}

// As the program pairs them: each video's own mask, whatever order the names sort to; as listed where each
// pattern finds one; and by the names of what a folder holds.
TEST(MaskPairs, OfAConfig) {
  const TempFolder folder;
  const auto put = [&](const std::string& name, double brightness) {
    for (const char* frame : {"/0.png", "/1.png"})
      WritePng(folder, name + frame, cv::Mat(16, 16, CV_32FC3, cv::Scalar::all(brightness)));
  };
  // A mask is as bright as its video.
  put("film/bear", 1), put("film/bear-2", 0.2), put("film/cat", 0.6);
  put("film_mask/bear_mask", 1), put("film_mask/bear-2_mask", 0.2), put("film_mask/cat_mask", 0.6);
  const auto expect_pairs = [&](const Json& sequence, const Json& masks) {
    folder.Put("c.json", SetConfig("sequence", 6,
                                   {{"size", {16, 16}},
                                    {"frames", 2},
                                    {"tilt", {{"strength_px", 0}}},
                                    {"blur", {{"max_sigma_px", 0}}},
                                    {"source", {{"sequence", sequence}, {"masks", masks}}},
                                    {"output", {{"truth", {"mask"}}}}}));
    fs::remove_all(folder / "set");
    ExpectDone(Generate(folder, "c.json", "set"));
    const dataset::DatasetReader reader(folder / "set");
    std::set<float> seen;
    for (int64_t clip = 0; clip < 6; ++clip) {
      const float own = reader.Clean(clip, 0).pixels.at<cv::Vec3f>(3, 3)[0];
      EXPECT_EQ(reader.TruthMask(clip, 0).value().at<float>(3, 3), own) << clip;
      seen.insert(own);
    }
    EXPECT_GT(seen.size(), 1u);
    for (const Json& record : reader.description().at("sources"))
      EXPECT_EQ(record.contains("mask_of"), !record.at("path").get<std::string>().starts_with("film/"));
  };
  expect_pairs("film/*", "film_mask/*");
  expect_pairs({"film/bear", "film/bear-2"}, {"film_mask/bear_mask", "film_mask/bear-2_mask"});
  // Names that tell nothing, in the order of the lists.
  put("m/z", 1), put("m/a", 0.6), put("m/k", 0.2);
  expect_pairs({"film/bear", "film/cat", "film/bear-2"}, {"m/z", "m/a", "m/k"});

  folder.Put("bad.json", SetConfig("sequence", 1,
                                   {{"source", {{"sequence", "film/*"}, {"masks", {"film_mask/bear*"}}}}}));
  ExpectOneLine(Generate(folder, "bad.json", "bad"), 2,
                {"bad.json:/source/masks: finds 2, must find one for each of the 3 (/source/sequence)"});
  folder.Put("worse.json",
             SetConfig("sequence", 1, {{"source", {{"sequence", "film/*"}, {"masks", "m/*"}}}}));
  ExpectOneLine(Generate(folder, "worse.json", "bad"), 2, {"worse.json:/source/masks: has none for film/"});
}

// What is white is moving: the mask lies where the picture shows it, however the clip was cut out of it.
TEST(MaskPairs, MasksFollowTheirFrames) {
  const TempFolder folder;
  for (int k = 0; k < 9; ++k)
    for (const char* name : {"film", "masks"}) {
      cv::Mat picture = cv::Mat::zeros(60, 90, CV_32FC3);
      cv::Rect box(5 + 6 * k, 10 + 3 * k, 21, 14);
      picture(box).setTo(cv::Scalar::all(1));
      WritePng(folder, std::string(name) + "/" + std::to_string(k) + ".png", picture);
    }
  for (const char* layout : {"sequence", "pairs"}) {
    folder.Put("c.json", SetConfig(layout, 12,
                                   {{"size", {40, 32}},
                                    {"frames", 4},
                                    {"first_frame", 2},
                                    {"tilt", {{"strength_px", 0}}},
                                    {"blur", {{"max_sigma_px", 0}}},
                                    {"source",
                                     {{"sequence", "film"},
                                      {"masks", "masks"},
                                      {"scale", {{"uniform", {0.6, 1.3}}}},
                                      {"flip", true}}},
                                    {"output", {{"truth", {"mask"}}, {"frames_per_clip", 2}}}}));
    const std::string set = std::string("set_") + layout;
    ExpectDone(Generate(folder, "c.json", set));
    const dataset::DatasetReader reader(folder / set);
    int flipped = 0, started_later = 0, with_white = 0;
    for (int64_t clip = 0; clip < 12; ++clip) {
      const Json source = reader.Line(clip).at("source");
      flipped += source.at("flip").get<bool>();
      started_later += source.at("start") > 0;
      for (int64_t k = 0; k < 2; ++k) {
        cv::Mat clean;
        cv::extractChannel(reader.Clean(clip, k).pixels, clean, 0);
        const cv::Mat mask = reader.TruthMask(clip, k).value();
        EXPECT_LE(cv::norm(clean, mask, cv::NORM_INF), 1.001 / 255) << set << " " << clip << " " << k;
        with_white += cv::countNonZero(mask > 0.5) > 50;
      }
    }
    EXPECT_GT(flipped, 0);
    EXPECT_LT(flipped, 12);
    EXPECT_GT(started_later, 0);
    EXPECT_GT(with_white, 6);
  }
}

}  // namespace
}  // namespace shimmer::app
