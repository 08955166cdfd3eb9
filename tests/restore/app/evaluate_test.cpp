// unshimmer evaluate, as people call it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "restore/psnr.h"
#include "restore/translate.h"
#include "sim/dataset/folder_lock.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/frames.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Two clips of a wall, of which the second shakes and has a box that moves; made once for all tests.
class Evaluate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    sets_ = std::make_unique<TempFolder>();
    Generate("set", R"({"shake": {"choice": ["walk", "none"]}, "amplitude_px": 2, "bound_px": 12})");
  }
  static void TearDownTestSuite() { sets_.reset(); }

  static void Generate(const std::string& name, const std::string& camera,
                       const std::string& truth = R"(["mask", "shake"])") {
    sets_->Put(name + ".json", R"({"seed": 3, "clips": 3, "frames": 9, "size": [96, 80],
      "source": {"drawn": "bricks"}, "tilt": {"strength_px": {"choice": [2, 4]}, "base_frequency": 0.06},
      "blur": {"max_sigma_px": 1}, "camera": )" +
                                   camera + R"(,
      "objects": [{"drawn": "box", "chance": 0.5, "height_px": 24, "hue": 0.6,
                   "motion": {"start_x": 0.2, "start_y": 0.6, "speed_px": 4}}],
      "output": {"truth": )" + truth +
                                   "}}");
    ExpectDone(shimmer::app::Shimmer(*sets_, {"generate", name + ".json", "--out", name, "--quiet"}));
  }
  static std::string Set(const std::string& name = "set") { return (*sets_ / name).string(); }

  Ran Run(const Words& more, const std::string& set = Set()) {
    Words words = {"evaluate", "--quiet", "--out", "report"};
    if (!set.empty()) words.insert(words.begin() + 1, set);
    words.insert(words.end(), more.begin(), more.end());
    return Unshimmer(folder_, words);
  }
  static void CopyTurb(const std::string& clip, const fs::path& to) {
    fs::create_directories(to.parent_path());
    fs::copy(Set() + "/clips/" + clip + "/turb", to);
  }
  Json Results() { return Json::parse(ReadText(folder_ / "report/results.json")); }

  static Json RowOf(const Json& clip, const std::string& variant, const std::string& stage = "result") {
    for (const Json& row : clip.at("rows"))
      if (row.at("variant") == variant && row.at("stage") == stage) return row;
    return nullptr;
  }

  static std::unique_ptr<TempFolder> sets_;
  const TempFolder folder_;
};
std::unique_ptr<TempFolder> Evaluate::sets_;

TEST_F(Evaluate, HoldsEachStageAgainstTheTruth) {
  const Ran ran = Run({});
  ExpectDone(ran);
  EXPECT_THAT(ran.out, AllOf(HasSubstr("full "), HasSubstr("report/report.html\n")));
  const Json results = Results();
  ASSERT_EQ(results.at("clips").size(), 3);
  const dataset::DatasetReader reader(Set());
  for (int64_t k = 0; k < 3; ++k) {
    const Json& clip = results.at("clips")[k];
    EXPECT_EQ(clip.at("clip"), "00000" + std::to_string(k));
    EXPECT_EQ(clip.at("tilt_rms_px"), reader.Line(k).at("tilt_rms_px"));
    EXPECT_EQ(clip.at("objects"), reader.Line(k).value("objects", Json::array()).size());
    for (const char* stage : {"stabilise", "stack", "blend", "sharpen", "result"})
      EXPECT_TRUE(RowOf(clip, "full", stage).at("psnr_db").is_number()) << stage;
    EXPECT_EQ(RowOf(clip, "full", "sharpen").at("psnr_db"), RowOf(clip, "full").at("psnr_db"));
    EXPECT_TRUE(RowOf(clip, "full", "stabilise").at("shift_error_mean_px").is_number());
    EXPECT_TRUE(RowOf(clip, "full", "segment").at("iou").is_number());
    EXPECT_GT(RowOf(clip, "full", "look").at("found_tilt_rms_px"), 0);
    double sum_ms = 0;
    for (const char* stage : {"look", "stabilise", "segment", "stack", "blend", "sharpen"})
      if (const Json row = RowOf(clip, "full", stage); row.contains("ms_per_frame"))
        sum_ms += row.at("ms_per_frame").get<double>();
    EXPECT_NEAR(RowOf(clip, "full").at("ms_per_frame"), sum_ms, 0.3 * sum_ms + 1);
    for (const char* picture : {"input.jpg", "result.jpg", "truth.jpg", "rows_input.png", "rows_result.png"})
      EXPECT_TRUE(fs::exists(folder_ / "report/pictures" / clip.at("clip").get<std::string>() / picture));
  }
}

// What is found with its own functions, from the files, by the protocol of docs/evaluation.md.
TEST_F(Evaluate, TheInputIsMovedByTheTrueShake) {
  ExpectDone(Run({}));
  const Json results = Results();
  const dataset::DatasetReader reader(Set());
  for (int64_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (int64_t frame = 0; frame < 9; ++frame) {
      const cv::Point2d s = (*reader.TruthShake(k))[static_cast<size_t>(frame)];
      cv::Mat turb, clean;
      reader.Turb(k, frame).pixels.convertTo(turb, CV_8U, 255);
      const auto clean_files = reader.Files(k).clean.size();
      reader.Clean(k, clean_files == 1 ? 0 : frame).pixels.convertTo(clean, CV_8U, 255);
      const cv::Rect seen = SeenArea(turb.size(), s);
      sum += Psnr(Translated(turb, s)(seen).clone(), clean(seen).clone());
    }
    EXPECT_NEAR(RowOf(results.at("clips")[k], "input").at("psnr_db"), sum / 9, 1e-9);
  }
}

TEST_F(Evaluate, TheResultIsWhatRestoreMakes) {
  ExpectDone(Run({}));
  ExpectDone(Unshimmer(folder_, {"restore", Set() + "/clips/000001", "--out", "out", "--quiet"}));
  fs::create_directories(folder_ / "results");
  fs::rename(folder_ / "out", folder_ / "results/000001");
  ExpectDone(Unshimmer(folder_, {"restore", Set() + "/clips/000000", "--out", "results/000000", "--quiet"}));
  ExpectDone(Run({"--method", "same=results", "--clips", "2"}));
  const Json results = Results();
  for (int k = 0; k < 2; ++k) {
    const Json& clip = results.at("clips")[k];
    for (const char* measure : {"psnr_db", "ssim", "psnr_background_db", "line_deviation_deg"})
      EXPECT_EQ(RowOf(clip, "same").at(measure), RowOf(clip, "full").at(measure)) << measure;
  }
}

TEST_F(Evaluate, AblationsAndBaselinesAreEvaluatedBeside) {
  ExpectDone(
      Run({"--ablations", "--baselines", "--variant", "soft:sharpen=off,register=off", "--clips", "2"}));
  const Json results = Results();
  for (const char* variant : {"input", "full", "no-stabilise", "no-segment", "no-stack", "no-sharpen", "aof",
                              "flow-farneback", "soft", "mean", "median", "lucky", "unsharp"})
    for (const Json& clip : results.at("clips"))
      EXPECT_TRUE(RowOf(clip, variant).at("psnr_db").is_number()) << variant;
  for (const Json& clip : results.at("clips"))
    EXPECT_EQ(RowOf(clip, "no-sharpen").at("psnr_db"), RowOf(clip, "full", "blend").at("psnr_db"));
  // A table of the same at the end, a CSV row each.
  const std::string csv = ReadText(folder_ / "report/results.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 2 * (13 + 6));
}

TEST_F(Evaluate, GoesOnWhereItStopped) {
  ExpectDone(Run({"--clips", "1"}));
  const std::string first = ReadText(folder_ / "report/clips/000000/full.json");
  EXPECT_EQ(Results().at("clips").size(), 1);
  EXPECT_EQ(Results().at("clips_of_set"), 3);
  const auto written = fs::last_write_time(folder_ / "report/clips/000000/full.json");
  ExpectDone(Run({}));
  EXPECT_EQ(Results().at("clips").size(), 3);
  EXPECT_EQ(fs::last_write_time(folder_ / "report/clips/000000/full.json"), written);
  // A variant more takes nothing away.
  ExpectDone(Run({"--variant", "plain:stack=off"}));
  EXPECT_EQ(fs::last_write_time(folder_ / "report/clips/000000/full.json"), written);
  EXPECT_EQ(Results().at("variants").size(), 3);
  ExpectDone(Run({}));
  EXPECT_EQ(Results().at("variants").size(), 3);
}

TEST_F(Evaluate, ShardsTogetherAreTheWhole) {
  for (const char* shard : {"1/2", "0/2"}) ExpectDone(Run({"--shard", shard}));
  Json in_parts = Results();
  fs::rename(folder_ / "report", folder_ / "parts");
  ExpectDone(Run({"--jobs", "2", "--threads", "1"}));
  Json whole = Results();
  const auto without_times = [](Json& results) {
    results.erase("summary");
    for (Json& clip : results.at("clips"))
      for (Json& row : clip.at("rows")) row.erase("ms_per_frame");
  };
  without_times(in_parts);
  without_times(whole);
  EXPECT_EQ(in_parts, whole);
}

TEST_F(Evaluate, ShardsAtOnceAndARunTooManyDoNotDisturbOneAnother) {
  const auto start = [&](const std::string& shard) {
    return shimmer::app::Running(folder_.path(),
                                 {"evaluate", Set(), "--out", "report", "--quiet", "--shard", shard}, false,
                                 UNSHIMMER_PROGRAM);
  };
  auto first = start("0/2"), second = start("1/2");
  ExpectDone(first.Wait());
  ExpectDone(second.Wait());
  EXPECT_EQ(Results().at("clips").size(), 3);
  const dataset::FolderLock lock(folder_ / "report", dataset::Shard());
  ExpectRefused(Run({}), 1, {"report"});
}

TEST_F(Evaluate, AReportOfAnotherSetOrAnotherVariantIsLeftAlone) {
  ExpectDone(Run({"--clips", "1", "--variant", "a:stack=off"}));
  Generate("other", "{}");
  ExpectRefused(Run({}, Set("other")), 2, {"report: holds an evaluation of another data set"});
  ExpectRefused(Run({"--variant", "a:stack=off,sharpen=off"}), 2,
                {"holds an evaluation of another variant 'a'"});
  ExpectRefused(Run({"--no-sharpen"}), 2, {"holds an evaluation of another variant 'full'"});
  folder_.Put("report2/notes.txt", std::string("mine"));
  ExpectRefused(Unshimmer(folder_, {"evaluate", Set(), "--out", "report2", "--quiet"}), 2,
                {"report2: is there already and no evaluation"});
}

TEST_F(Evaluate, WhatCantBeEvaluatedIsRefusedBeforeAnythingIsTouched) {
  Generate("shaken", R"({"shake": "walk", "amplitude_px": 2, "bound_px": 12})", R"(["mask"])");
  ExpectRefused(Run({}, Set("shaken")), 2,
                {"shakes, and its shifts were not written", "output.truth must name \"shake\""});
  ExpectRefused(Run({}, (folder_ / "none").string()), 1, {"none"});
  ExpectRefused(Run({}, ""), 2, {"nothing to evaluate"});
  ExpectRefused(Run({"--method", "x=nowhere"}), 2, {"nowhere: has no results of clip 000000"});
  ExpectRefused(Run({"--model", "none.safetensors"}), 1, {"none.safetensors"});
  ExpectRefused(Run({"--variant", "raft:flow=none.pt"}), 1, {"none.pt: is not there"});
  ExpectRefused(Run({"--shard", "2/2"}), 2, {"--shard"});
  ExpectRefused(Run({"--border", "crop"}), 2, {"must be fill"});
  EXPECT_FALSE(fs::exists(folder_ / "report"));
}

TEST_F(Evaluate, AClipThatFailsIsRecordedAndTheRestGoesOn) {
  fs::copy(Set(), folder_ / "damaged", fs::copy_options::recursive);
  fs::resize_file(folder_ / "damaged/clips/000001/turb/0004.png", 100);
  const Ran ran = Run({}, (folder_ / "damaged").string());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("unshimmer: clip 000001, "), HasSubstr("0004.png")));
  const Json failed = Results();
  EXPECT_THAT(failed.at("clips")[1].at("errors")[0].at("error").get<std::string>(), HasSubstr("0004.png"));
  EXPECT_TRUE(RowOf(failed.at("clips")[2], "full").at("psnr_db").is_number());
  // Mended, only it is done again.
  fs::copy_file(Set() + "/clips/000001/turb/0004.png", folder_ / "damaged/clips/000001/turb/0004.png",
                fs::copy_options::overwrite_existing);
  ExpectDone(Run({}, (folder_ / "damaged").string()));
  EXPECT_TRUE(Results().at("clips")[1].at("errors").empty());
}

TEST_F(Evaluate, AMethodWithAFrameTooFewIsAnErrorOfItsClip) {
  for (const char* clip : {"000000", "000001", "000002"}) CopyTurb(clip, folder_ / "method" / clip);
  fs::remove(folder_ / "method/000002/0008.png");
  const Ran ran = Run({"--method", "turb=method"});
  EXPECT_EQ(ran.exit_code, 1);
  const Json results = Results();
  EXPECT_THAT(results.at("clips")[2].at("errors")[0].at("error").get<std::string>(),
              HasSubstr("has 8 frames, must have 9 as the clip"));
  EXPECT_TRUE(RowOf(results.at("clips")[0], "turb").at("psnr_db").is_number());
}

TEST_F(Evaluate, RealVideosHaveNoTruth) {
  CopyTurb("000000", folder_ / "real one");
  ExpectDone(Run({"--real", "real one"}, ""));
  const Json results = Results();
  EXPECT_TRUE(results.at("clips").empty());
  const Json& video = results.at("real")[0];
  EXPECT_EQ(video.at("clip"), "real one");
  EXPECT_TRUE(video.at("tilt_rms_px").is_null());
  for (const char* variant : {"input", "full"}) {
    EXPECT_FALSE(RowOf(video, variant).contains("psnr_db"));
    EXPECT_TRUE(RowOf(video, variant).at("stability_levels").is_number());
  }
  EXPECT_LT(RowOf(video, "full").at("stability_levels"), RowOf(video, "input").at("stability_levels"));
  EXPECT_TRUE(fs::exists(folder_ / "report/pictures/real one/result.jpg"));
  EXPECT_THAT(ReadText(folder_ / "report/results.csv"), HasSubstr("real one,real,9,96,80,,,,,full,result,"));
}

// Others' truth is of the frames as they were: it goes with what stabilising does to them.
TEST_F(Evaluate, SetsOfOthersAreReadThroughAnAdapter) {
  for (const char* clip : {"000000", "000001"}) {
    CopyTurb(clip, folder_ / "others/in" / clip);
    CopyTurb(clip, folder_ / "others/gt" / clip);
  }
  folder_.Put(
      "adapter.json",
      std::string(R"({"name": "others", "turb": "in/{clip}", "clean": "gt/{clip}", "margin_px": 3})"));
  ExpectDone(Run({"--adapter", "adapter.json", "--no-stack", "--no-sharpen"}, "others"));
  const Json results = Results();
  for (const Json& clip : results.at("clips")) {
    EXPECT_EQ(RowOf(clip, "input").at("psnr_db"), "inf");
    // (but for the borders that are filled, and rounding of what is moved)
    const Json full = RowOf(clip, "full").at("psnr_db");
    EXPECT_TRUE(full == "inf" || full.get<double>() > 40) << full;
  }
  folder_.Put("adapter.json",
              std::string(R"({"name": "others", "turb": "in/{clip}/x", "clean": "gt/{clip}"})"));
  fs::remove_all(folder_ / "report");
  EXPECT_EQ(Run({"--adapter", "adapter.json"}, "others").exit_code, 1);
  EXPECT_THAT(Results().at("clips")[0].at("errors")[0].at("error").get<std::string>(),
              HasSubstr("in/000000/x"));
  ExpectRefused(Run({"--adapter", "none.json"}, "others"), 1, {"none.json"});
}

}  // namespace
}  // namespace shimmer::restore::app
