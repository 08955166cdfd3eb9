#include "restore/app/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "cli/exit_codes.h"
#include "restore/psnr.h"
#include "restore/ssim.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/frames.h"

namespace shimmer::restore::app {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

Ran Compare(const TempFolder& folder, const Words& more) {
  Words words = {"compare", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return Unshimmer(folder, words);
}

void Put(const TempFolder& folder, const std::string& name, const cv::Mat& frame, int bits = 8) {
  folder.Put(name, dataset::EncodePng(frame, bits));
}

Json ReadJson(const TempFolder& folder, const std::string& name) {
  return Json::parse(ReadText(folder / name));
}

// A line of the table by its label, as words.
Words LineOf(const std::string& table, const std::string& label) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(label)) continue;
    std::istringstream rest(line.substr(label.size()));
    Words words;
    for (std::string word; rest >> word;) words.push_back(word);
    return words;
  }
  return {};
}

// B is flat; A is off by 1, 51 and 0 levels.
TEST(Compare, PrintsMeansAndTheWorstFrame) {
  const TempFolder folder;
  const double off[] = {1, 51, 0};
  for (int t = 0; t < 3; ++t) {
    Put(folder, "a/" + std::to_string(t) + ".png", Flat({20, 12}, CV_8UC1, 100 + off[t]));
    Put(folder, "b/" + std::to_string(t) + ".png", Flat({20, 12}, CV_8UC1, 100));
  }
  const Ran ran = Compare(folder, {"a", "b", "--json", "out.json"});
  ExpectDone(ran);
  EXPECT_THAT(ran.out, HasSubstr("A: a, 3 frames of 20x12 px\nB: b, 3 frames\n"));
  EXPECT_EQ(LineOf(ran.out, "PSNR, dB"), (Words{"inf", "13.98", "1"}));  // 20 log10(255 / 51)
  EXPECT_EQ(LineOf(ran.out, "PSNR-Y, dB"), (Words{"inf", "13.98", "1"}));
  EXPECT_EQ(LineOf(ran.out, "line deviation, deg"), (Words{"-", "-"}));
  EXPECT_EQ(LineOf(ran.out, "stability, levels"), (Words{"50.500", "0.000"}));  // (50 + 51) / 2

  const Json json = ReadJson(folder, "out.json");
  EXPECT_EQ(json["size"], Json({20, 12}));
  EXPECT_EQ(json["mean"]["psnr_db"], "inf");
  EXPECT_EQ(json["frames"][2]["psnr_db"], "inf");
  EXPECT_NEAR(json["frames"][0]["psnr_db"].get<double>(), 20 * std::log10(255.0), 1e-9);
  EXPECT_EQ(json["worst"]["psnr_db"]["frame"], 1);
  const double flat = (2 * 151 * 100 + 6.5025) / (151 * 151 + 100 * 100 + 6.5025);
  for (const char* name : {"ssim_opencv", "ssim_scikit_image", "ssim_y"}) {
    EXPECT_NEAR(json["worst"][name]["value"].get<double>(), flat, 1e-9) << name;
    EXPECT_EQ(json["frames"][2][name], 1) << name;
  }
  EXPECT_EQ(json["frames"][0]["a"]["difference_levels"], nullptr);
  EXPECT_EQ(json["frames"][1]["a"]["difference_levels"], 50);
  EXPECT_EQ(json["a"]["line_deviation_deg"], nullptr);
}

// A still B counts for every frame, and has no stability; so has a still A.
TEST(Compare, AStillStandsForAllFrames) {
  const TempFolder folder;
  const cv::Mat clean = Noise({40, 30}, CV_8UC3, 1);
  Put(folder, "clean.png", clean);
  for (int t = 0; t < 3; ++t) Put(folder, "a/" + std::to_string(t) + ".png", Noise({40, 30}, CV_8UC3, 2 + t));
  ExpectDone(Compare(folder, {"a/%d.png", "clean.png", "--json", "out.json"}));
  const Json json = ReadJson(folder, "out.json");
  EXPECT_EQ(json["b"]["frames"], 1);
  EXPECT_EQ(json["b"]["stability_levels"], nullptr);
  EXPECT_GT(json["a"]["stability_levels"], 0);
  for (int t = 0; t < 3; ++t) {
    const cv::Mat frame = Noise({40, 30}, CV_8UC3, 2 + t);
    const Json& scores = json["frames"][t];
    EXPECT_DOUBLE_EQ(scores["psnr_db"], Psnr(frame, clean));
    EXPECT_DOUBLE_EQ(scores["psnr_y_db"], PsnrY(frame, clean));
    EXPECT_DOUBLE_EQ(scores["ssim_opencv"], SsimOpenCv(frame, clean));
    EXPECT_DOUBLE_EQ(scores["ssim_scikit_image"], *SsimScikitImage(frame, clean));
    EXPECT_DOUBLE_EQ(scores["ssim_y"], SsimY(frame, clean));
  }
  const Ran stills = Compare(folder, {"clean.png", "clean.png"});
  ExpectDone(stills);
  EXPECT_EQ(LineOf(stills.out, "stability, levels"), (Words{"-", "-"}));
}

// A square that goes right by its own width; the rest flickers by 3 levels. With the mask only that is left.
TEST(Compare, TheMaskLeavesOutWhatMoves) {
  const TempFolder folder;
  for (int t = 0; t < 4; ++t) {
    const std::string name = "/" + std::to_string(t) + ".png";
    cv::Mat frame = Flat({48, 16}, CV_8UC1, 100 + 3 * (t % 2)), mask = Flat({48, 16}, CV_8UC1, 0);
    const cv::Rect square(8 * t, 4, 8, 8);
    frame(square).setTo(250);
    mask(square).setTo(255);
    Put(folder, "a" + name, frame);
    Put(folder, "mask" + name, mask);
  }
  const Ran ran = Compare(folder, {"a", "a", "--mask", "mask"});
  ExpectDone(ran);
  EXPECT_EQ(LineOf(ran.out, "stability, levels"), (Words{"3.000", "3.000"}));
  EXPECT_GT(std::stod(LineOf(Compare(folder, {"a", "a"}).out, "stability, levels")[0]), 20);
  Put(folder, "all.png", Flat({48, 16}, CV_8UC1, 255));
  EXPECT_EQ(LineOf(Compare(folder, {"a", "a", "--mask", "all.png"}).out, "stability, levels"),
            (Words{"-", "-"}));
}

// Upright in A, turned by 45 degrees in B.
TEST(Compare, SaysHowStraightEachIs) {
  const TempFolder folder;
  cv::Mat upright = Flat({128, 128}, CV_8UC1, 0), slanted = upright.clone();
  upright.colRange(64, 128).setTo(255);
  for (int y = 0; y < 128; ++y) slanted.row(y).colRange(y, 128).setTo(255);
  Put(folder, "upright.png", upright);
  Put(folder, "slanted.png", slanted);
  const Ran ran = Compare(folder, {"upright.png", "slanted.png"});
  ExpectDone(ran);
  EXPECT_EQ(LineOf(ran.out, "line deviation, deg"), (Words{"0.00", "45.00"}));
  EXPECT_EQ(LineOf(ran.out, "  its rolling sd"), (Words{"-", "-"}));  // of one picture
  for (int t = 0; t < 3; ++t) Put(folder, "both/" + std::to_string(t) + ".png", t == 1 ? slanted : upright);
  // 0, 45, 0: spreads of 0, of 22.5, and of sqrt((2 15^2 + 30^2) / 3)
  const Ran both = Compare(folder, {"both", "both"});
  EXPECT_EQ(LineOf(both.out, "line deviation, deg"), (Words{"15.00", "15.00"}));
  EXPECT_EQ(LineOf(both.out, "  its rolling sd"), (Words{"14.57", "14.57"}));
}

// Boxes of 6x4 px that share 3x4; then two empty masks.
TEST(Compare, ScoresMasks) {
  const TempFolder folder;
  for (int t = 0; t < 2; ++t) {
    cv::Mat found = Flat({20, 12}, CV_8UC1, 0), truth = found.clone();
    if (t == 0) found(cv::Rect(2, 3, 6, 4)).setTo(255), truth(cv::Rect(5, 3, 6, 4)).setTo(255);
    Put(folder, "found/" + std::to_string(t) + ".png", found);
    Put(folder, "truth/" + std::to_string(t) + ".png", truth);
  }
  const Ran ran = Compare(folder, {"found", "truth", "--iou", "--json", "out.json"});
  ExpectDone(ran);
  EXPECT_EQ(LineOf(ran.out, "IoU"), (Words{"0.6667", "0.3333", "0"}));
  EXPECT_EQ(LineOf(ran.out, "precision"), (Words{"0.7500", "0.5000", "0"}));
  EXPECT_EQ(LineOf(ran.out, "recall"), (Words{"0.7500", "0.5000", "0"}));
  EXPECT_THAT(ran.out, testing::Not(HasSubstr("PSNR")));
  EXPECT_THAT(ran.out, testing::Not(HasSubstr("stability")));
  const Json json = ReadJson(folder, "out.json");
  EXPECT_EQ(json["frames"][0], Json({{"frame", 0}, {"iou", 12.0 / 36}, {"precision", 0.5}, {"recall", 0.5}}));
  EXPECT_EQ(json["frames"][1], Json({{"frame", 1}, {"iou", 1}, {"precision", 1}, {"recall", 1}}));
  EXPECT_EQ(json["a"], Json({{"path", "found"}, {"frames", 2}}));
  ExpectRefused(Compare(folder, {"found", "truth", "--iou", "--mask", "truth"}), 2, {"--mask", "--iou"});
}

TEST(Compare, DrawsARowOverTime) {
  const TempFolder folder;
  for (int t = 0; t < 5; ++t) {
    cv::Mat frame = Flat({9, 7}, CV_16UC1, 10);
    frame.row(3).setTo(257 * (20 + t));
    frame.row(6).setTo(257 * (90 + t));
    Put(folder, "a/" + std::to_string(t) + ".png", frame, 16);
  }
  Put(folder, "b.png", Flat({9, 7}, CV_8UC1, 44));
  ExpectDone(Compare(folder, {"a", "b.png", "--slices", "middle"}));
  ExpectDone(Compare(folder, {"a", "b.png", "--slices", "last", "--row", "6"}));
  for (const auto& [name, first] : {std::pair("middle", 20), std::pair("last", 90)}) {
    const cv::Mat slice = dataset::ReadSamples(folder / (std::string(name) + "/a.png")).pixels;
    ASSERT_EQ(slice.size(), cv::Size(9, 5));
    for (int t = 0; t < 5; ++t) EXPECT_EQ(slice.at<uint8_t>(t, 4), first + t);
    EXPECT_EQ(dataset::ReadSamples(folder / (std::string(name) + "/b.png")).pixels.size(), cv::Size(9, 1));
  }
  ExpectRefused(Compare(folder, {"a", "b.png", "--slices", "none", "--row", "7"}), 2,
                {"row = 7, must be in [0, 6]"});
  ExpectRefused(Compare(folder, {"a", "b.png", "--row", "3"}), 2, {"--slices"});
}

TEST(Compare, OneLineForWhatCannotBeCompared) {
  const TempFolder folder;
  for (int t = 0; t < 3; ++t) Put(folder, "a/" + std::to_string(t) + ".png", Flat({8, 9}, CV_8UC1, 1));
  for (int t = 0; t < 2; ++t) Put(folder, "two/" + std::to_string(t) + ".png", Flat({8, 9}, CV_8UC1, 1));
  Put(folder, "wide.png", Flat({9, 8}, CV_8UC1, 1));
  Put(folder, "one.png", Flat({8, 9}, CV_8UC1, 1));
  Put(folder, "mixed/0.png", Flat({8, 9}, CV_8UC1, 1));
  Put(folder, "mixed/1.png", Flat({8, 8}, CV_8UC1, 1));
  Put(folder, "gap/1.png", Flat({8, 9}, CV_8UC1, 1));
  Put(folder, "gap/3.png", Flat({8, 9}, CV_8UC1, 1));
  folder.Put("cut.png", "\x89PNG");
  ExpectRefused(Compare(folder, {"a", "two"}), 2, {"two: has 2 frames, must have 3 as a, or 1"});
  ExpectRefused(Compare(folder, {"one.png", "two"}), 2, {"two: has 2 frames, must have 1 as one.png"});
  ExpectRefused(Compare(folder, {"a", "one.png", "--mask", "two"}), 2, {"two: has 2 frames"});
  ExpectRefused(Compare(folder, {"a", "wide.png"}), 2, {"wide.png: is 9x8 px, must be 8x9 as a"});
  ExpectRefused(Compare(folder, {"a", "a", "--mask", "wide.png"}), 2, {"wide.png: is 9x8 px"});
  ExpectRefused(Compare(folder, {"mixed", "two"}), 1, {"1.png: another size"});
  ExpectRefused(Compare(folder, {"gap/%d.png", "one.png"}), 1, {"2.png: missing"});
  ExpectRefused(Compare(folder, {"cut.png", "one.png"}), 1, {"cut.png"});
  ExpectRefused(Compare(folder, {"absent", "one.png"}), 1, {"absent: is not there"});
  ExpectRefused(Compare(folder, {"a"}), 2, {"B is required", "unshimmer --help"});
  ExpectRefused(Compare(folder, {"a", "a", "--threads", "0"}), 2, {"--threads"});
  ExpectRefused(Compare(folder, {"a", "a", "--json", "nowhere/out.json"}), 1, {"nowhere/out.json"});
  const Ran unknown = shimmer::app::Running(folder.path(), {"comprae"}, false, UNSHIMMER_PROGRAM).Wait();
  ExpectRefused(unknown, 2, {"unknown command 'comprae', must be 'compare'"});
}

TEST(Compare, FramesOfLessThanAWindow) {
  const TempFolder folder;
  Put(folder, "a.png", Flat({6, 40}, CV_8UC3, 30));
  Put(folder, "dot.png", Flat({1, 1}, CV_8UC1, 30));
  for (const char* name : {"a.png", "dot.png"}) {
    const Ran ran = Compare(folder, {name, name});
    ExpectDone(ran);
    EXPECT_EQ(LineOf(ran.out, "SSIM (scikit-image)"), (Words{"-", "-", "-"}));
    EXPECT_EQ(LineOf(ran.out, "SSIM (OpenCV)"), (Words{"1.0000", "1.0000", "0"}));
  }
}

// The same light in 8 and in 16 bits is equal.
TEST(Compare, DepthsMayDiffer) {
  const TempFolder folder;
  cv::Mat words;
  const cv::Mat bytes = Noise({31, 22}, CV_8UC3, 4);
  bytes.convertTo(words, CV_16U, 257);
  Put(folder, "bytes.png", bytes);
  Put(folder, "words.png", words, 16);
  EXPECT_EQ(LineOf(Compare(folder, {"bytes.png", "words.png"}).out, "PSNR, dB"), (Words{"inf", "inf", "0"}));
}

// Asked to stop, it writes nothing.
TEST(Compare, EndsInGoodOrder) {
  const TempFolder folder;
  Put(folder, "a.png", Flat({8, 8}, CV_8UC1, 1));
  const CompareOptions options{.a = folder / "a.png",
                               .b = folder / "a.png",
                               .mask = {},
                               .json = folder / "out.json",
                               .slices = folder / "slices",
                               .row = {},
                               .quiet = true};
  testing::internal::CaptureStdout();
  EXPECT_EQ(Compare(options, std::atomic<bool>(true)), cli::kExitInterrupted);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "slices"));
}

// The same on any number of threads, to the last byte.
TEST(Compare, IsTheSameOnAnyNumberOfThreads) {
  const TempFolder folder;
  for (int t = 0; t < 9; ++t) {
    cv::Mat frame = Noise({90, 80}, CV_8UC3, static_cast<uint32_t>(t));
    cv::Mat(frame, cv::Rect(10 + t, 0, 30, 80)).setTo(cv::Scalar::all(255));
    Put(folder, "a/" + std::to_string(t) + ".png", frame);
    Put(folder, "b/" + std::to_string(t) + ".png", Noise({90, 80}, CV_8UC3, 100 + static_cast<uint32_t>(t)));
  }
  Ran first{};
  for (const std::string threads : {"1", "2", "7"}) {
    const Ran ran = Compare(
        folder, {"a", "b", "--json", threads + ".json", "--slices", "s" + threads, "--threads", threads});
    ExpectDone(ran);
    if (threads == "1") {
      first = ran;
      continue;
    }
    EXPECT_EQ(ran.out, first.out);
    EXPECT_EQ(ReadText(folder / (threads + ".json")), ReadText(folder / "1.json"));
    EXPECT_EQ(ReadText(folder / ("s" + threads + "/a.png")), ReadText(folder / "s1/a.png"));
  }
}

// 10 or 100 frames of 240 kB each, all the same file: were they kept, that would be 21 MB more.
TEST(Compare, KeepsFewFrames) {
  const TempFolder folder;
  Put(folder, "frame.png", Flat({400, 200}, CV_8UC3, 77));
  int64_t peak_bytes[2] = {};
  for (const int count : {10, 100}) {
    const std::string name = std::to_string(count);
    std::filesystem::create_directories(folder / name);
    for (int t = 0; t < count; ++t)
      std::filesystem::create_hard_link(folder / "frame.png",
                                        folder / (name + "/" + std::to_string(t) + ".png"));
    const Ran ran = Compare(folder, {name, "frame.png", "--threads", "2"});
    ExpectDone(ran);
    peak_bytes[count == 100] = ran.peak_bytes;
  }
  EXPECT_LT(peak_bytes[1], peak_bytes[0] + (10 << 20));
}

}  // namespace
}  // namespace shimmer::restore::app
