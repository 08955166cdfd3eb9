// What evaluations are put together from: variants, adapters, means, texts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "restore/app/evaluation/adapter.h"
#include "restore/app/evaluation/result_text.h"
#include "restore/app/evaluation/sequence_meter.h"
#include "restore/app/evaluation/summary.h"
#include "restore/app/evaluation/variants.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/frames.h"

namespace shimmer::restore::app {
namespace {

using dataset::ErrorOf;
using testing::ElementsAre;
using testing::HasSubstr;

// ---- Means

std::vector<Value> Numbers(int count) {
  std::vector<Value> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(i % 2 == 0 ? 1 : 3);
  return numbers;
}

// For so many numbers that are 1 and 3 by turns (an even number of them) the standard deviation is
// sqrt(n / (n - 1)), and the margin t / sqrt(n - 1): t as statistical tables print it.
TEST(EvaluationMeans, MarginsAreStudents) {
  const std::pair<int, double> tables[] = {{2, 12.706}, {4, 3.182},  {6, 2.571},   {10, 2.262},
                                           {20, 2.093}, {40, 2.023}, {1000, 1.962}};
  for (const auto& [count, t] : tables) {
    const auto mean = MeanOf(Numbers(count));
    EXPECT_EQ(mean->mean, 2);
    EXPECT_EQ(mean->clips, count);
    EXPECT_NEAR(*mean->margin * std::sqrt(count - 1), t, 0.001) << count;
  }
}

TEST(EvaluationMeans, AreOfWhatIsThere) {
  EXPECT_FALSE(MeanOf({}));
  EXPECT_FALSE(MeanOf(std::vector<Value>{{}, {}}));
  const auto one = MeanOf(std::vector<Value>{{}, 5.0});
  EXPECT_EQ(one->mean, 5);
  EXPECT_FALSE(one->margin);
  const auto infinite = MeanOf(std::vector<Value>{1.0, std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isinf(infinite->mean));
  EXPECT_FALSE(infinite->margin);
}

TEST(EvaluationMeans, RankCorrelationIsSpearmans) {
  const std::vector<double> rising = {1, 2, 3, 4, 5}, bent = {0, 1, 10, 100, 1000}, falling = {5, 4, 3, 2, 1};
  EXPECT_NEAR(*RankCorrelation(rising, bent), 1, 1e-12);
  EXPECT_NEAR(*RankCorrelation(rising, falling), -1, 1e-12);
  // By hand: ranks 1, 2.5, 2.5, 4 against 2, 1, 3, 4.
  const std::vector<double> ties = {1, 2, 2, 3}, other = {5, 4, 6, 7};
  EXPECT_NEAR(*RankCorrelation(ties, other), 3 / std::sqrt(4.5 * 5), 1e-12);
  EXPECT_FALSE(RankCorrelation(std::vector<double>{1, 1, 1}, std::vector<double>{1, 2, 3}));
  EXPECT_FALSE(RankCorrelation(std::vector<double>{1, 2}, std::vector<double>{1, 2}));
}

ClipResult Clip(const std::string& name, double tilt_px, std::optional<int> objects, double input_db,
                double full_db) {
  ClipResult clip{.facts = {.name = name,
                            .frames = 3,
                            .size = {4, 5},
                            .tilt_rms_px = tilt_px,
                            .shakes = objects == 0,
                            .objects = objects},
                  .rows = {},
                  .errors = {}};
  for (const auto& [variant, db] : {std::pair(kInputName, input_db), std::pair(kFullName, full_db)}) {
    clip.rows.push_back({variant, kResultStage, {}});
    clip.rows.back().measures[Measure::kPsnr] = db;
  }
  return clip;
}

TEST(EvaluationMeans, GroupsAreByStrengthShakeAndObjects) {
  const std::vector<ClipResult> clips = {Clip("a", 0.5, 0, 20, 23), Clip("b", 1, 2, 22, 23),
                                         Clip("c", 2, 2, 10, 15), Clip("d", 1.2, {}, 10, 9)};
  std::vector<std::string> names;
  for (const ClipGroup& group : GroupsOf(clips))
    names.push_back(group.key + "=" + group.value + ":" + std::to_string(group.clips.size()));
  EXPECT_THAT(names, ElementsAre("all=:4", "strength=weak:1", "strength=medium:2", "strength=strong:1",
                                 "shake=no:3", "shake=yes:1", "objects=0:1", "objects=2:2"));
  const auto gain = MeanIn(GroupsOf(clips)[0], kFullName, kResultStage, Measure::kPsnr, true);
  EXPECT_NEAR(gain->mean, (3 + 1 + 5 - 1) / 4.0, 1e-12);
  EXPECT_FALSE(MeanIn(GroupsOf(clips)[0], "other", kResultStage, Measure::kPsnr, true));
  EXPECT_FALSE(MeanIn(GroupsOf(clips)[0], kFullName, kResultStage, Measure::kIou, false));
}

// ---- Sequences

TrueFrame Truth(const cv::Mat& clean, const cv::Mat& moving) {
  return {.clean = clean, .moving = moving, .seen = cv::Mat(clean.size(), CV_8UC1, cv::Scalar(255))};
}

// The foreground off by 16 levels, the rest by 4, half of the frame not seen and off by 100.
TEST(EvaluationMeter, WhatIsNotSeenCountsForNobody) {
  const cv::Size size(40, 30);
  cv::Mat clean = Flat(size, CV_8UC1, 100), frame = Flat(size, CV_8UC1, 104),
          moving = cv::Mat::zeros(size, CV_8UC1);
  const cv::Rect thing(2, 3, 5, 6);
  moving(thing).setTo(255);
  frame(thing).setTo(116);
  frame.colRange(20, 40).setTo(200);
  TrueFrame truth = Truth(clean, moving);
  truth.seen.colRange(20, 40).setTo(0);
  SequenceMeter meter;
  meter.Add(frame, truth);
  meter.Add(frame, truth);
  Measures measures;
  meter.AddTo(measures);
  const auto db = [](double mse) { return 10 * std::log10(255 * 255 / mse); };
  EXPECT_NEAR(*measures[Measure::kPsnrForeground], db(256), 1e-9);
  EXPECT_NEAR(*measures[Measure::kPsnrBox], db(256), 1e-9);
  EXPECT_NEAR(*measures[Measure::kPsnrBackground], db(16), 1e-9);
  EXPECT_NEAR(*measures[Measure::kPsnr], db((256 * 30 + 16 * 570) / 600.0), 1e-9);
  EXPECT_EQ(measures[Measure::kStability], 0);
  EXPECT_EQ(measures[Measure::kIou], std::nullopt);
}

TEST(EvaluationMeter, MasksOfNothingAreRight) {
  const cv::Size size(10, 10);
  const cv::Mat nothing = cv::Mat::zeros(size, CV_8UC1);
  MaskMeter meter;
  meter.Add({}, Truth(nothing, nothing));
  Measures measures;
  meter.AddTo(measures);
  EXPECT_EQ(measures[Measure::kIou], 1);
  cv::Mat half = nothing.clone(), found = nothing.clone();
  half.rowRange(0, 4).setTo(255);
  found.rowRange(2, 6).setTo(200);
  MaskMeter other;
  other.Add(found, Truth(nothing, half));
  other.AddTo(measures);
  EXPECT_NEAR(*measures[Measure::kIou], 20 / 60.0, 1e-12);
  EXPECT_NEAR(*measures[Measure::kPrecision], 0.5, 1e-12);
  EXPECT_NEAR(*measures[Measure::kRecall], 0.5, 1e-12);
}

TEST(EvaluationMeter, ShiftErrorsThatNineteenOfTwentyAreWithin) {
  std::vector<double> errors;
  for (int i = 20; i >= 1; --i) errors.push_back(i);
  Measures measures;
  AddShiftErrors(errors, measures);
  EXPECT_EQ(measures[Measure::kShiftMean], 10.5);
  EXPECT_EQ(measures[Measure::kShiftP95], 19);
  EXPECT_EQ(measures[Measure::kShiftMost], 20);
  AddShiftErrors({7}, measures);
  EXPECT_EQ(measures[Measure::kShiftP95], 7);
}

// ---- Variants

std::vector<std::string> NamesOf(const std::vector<Variant>& variants) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.push_back(variant.name);
  return names;
}

TEST(EvaluationVariants, AreInOrder) {
  VariantOptions options{.ablations = true,
                         .baselines = true,
                         .changed = {"soft:stack=off,segment=aof"},
                         .methods = {"TMT=results/tmt"}};
  const auto variants = VariantsOf(options);
  EXPECT_THAT(NamesOf(variants),
              ElementsAre("input", "full", "no-stabilise", "no-segment", "no-stack", "no-sharpen", "aof",
                          "flow-farneback", "soft", "mean", "median", "lucky", "unsharp", "TMT"));
  const Variant& soft = variants[8];
  EXPECT_FALSE(soft.settings.params.stack);
  EXPECT_EQ(soft.settings.params.method, SegmentMethod::kAof);
  EXPECT_TRUE(soft.settings.params.stabilise);
  EXPECT_EQ(variants.back().folder, "results/tmt");
  EXPECT_EQ(variants.back().kind, VariantKind::kMethod);
}

TEST(EvaluationVariants, ChangesAreOfWhatWasAskedForInAll) {
  VariantOptions options;
  options.settings.params.registered = Register::kOff;
  options.changed = {"a:segment=off"};
  const auto variants = VariantsOf(options);
  EXPECT_EQ(variants[2].settings.params.registered, Register::kOff);
  EXPECT_NE(variants[1].Identity(), variants[2].Identity());
  EXPECT_EQ(variants[1].Identity(), VariantsOf(options)[1].Identity());
}

TEST(EvaluationVariants, WhatIsNoneIsRefused) {
  const std::pair<VariantOptions, const char*> cases[] = {
      {{.changed = {"a"}}, "--variant a: must be NAME:SETTING=VALUE"},
      {{.changed = {"a:"}}, "must be NAME:SETTING=VALUE"},
      {{.changed = {"a:stack"}}, "'stack' must be SETTING=VALUE"},
      {{.changed = {"a:stack=no"}}, "stack=no: must be 'off' or 'on'"},
      {{.changed = {"a:segment=otsu"}}, "segment=otsu: must be 'aof', 'fused' or 'off'"},
      {{.changed = {"a:blur=off"}}, "there is no such setting"},
      {{.changed = {"full:stack=off"}}, "the name is taken"},
      {{.changed = {"a/b:stack=off"}}, "must be of letters"},
      {{.changed = {"..:stack=off"}}, "must be of letters"},
      {{.methods = {"TMT"}}, "must be NAME=FOLDER"},
      {{.methods = {"TMT="}}, "must be NAME=FOLDER"},
      {{.methods = {"x=a", "x=b"}}, "the name is taken"}};
  for (const auto& [options, what] : cases)
    EXPECT_THAT(ErrorOf<std::invalid_argument>([&] { VariantsOf(options); }), HasSubstr(what));
  VariantOptions crop;
  crop.settings.params.border = Border::kCrop;
  EXPECT_THAT(ErrorOf<std::invalid_argument>([&] { VariantsOf(crop); }), HasSubstr("must be fill"));
}

// ---- Adapters

TEST(EvaluationAdapter, FindsClipsByWhatStandsForTheirName) {
  const TempFolder folder;
  for (const char* file : {"a/turb/0.png", "b/turb/0.png", "c/other.txt", ".hidden/turb/0.png"})
    folder.Put(std::string("one/") + file, "x");
  for (const char* file : {"x_1_001.png", "x_1_002.png", "y_001.png"})
    folder.Put(std::string("two/") + file, "x");
  const auto clips = [&](const std::string& turb, const std::string& below) {
    return Adapter{.name = "all", .turb = {turb}}.ClipsIn(folder / below);
  };
  EXPECT_THAT(clips("{clip}/turb", "one"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(clips("one/{clip}/turb", ""), ElementsAre("a", "b", "c"));
  EXPECT_THAT(clips("{clip}_%03d.png", "two"), ElementsAre("x_1", "y"));
  EXPECT_THAT(clips("x_{clip}.png", "two"), ElementsAre("1_001", "1_002"));
  EXPECT_THAT(clips("x_1_%03d.png", "two"), ElementsAre("all"));
  EXPECT_EQ((AdapterPath{"gt/{clip}/{clip}.png"}.Of("a")), "gt/a/a.png");
}

TEST(EvaluationAdapter, WhatIsWrongIsNamed) {
  const TempFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {"[1]", "must be a JSON object"},
      {"{", "is no JSON"},
      {R"({"turb": "a", "clean": "b"})", "name: is missing"},
      {R"({"name": "n", "clean": "b"})", "turb: is missing"},
      {R"({"name": "n", "turb": "a"})", "clean: is missing, and so is mask"},
      {R"({"name": "n", "turb": "a", "clean": "/b"})", "clean: must be a path below"},
      {R"({"name": "n", "turb": "{clip}/{clip}", "clean": "b"})", "turb: must have {clip} once"},
      {R"({"name": "n", "turb": "*.png", "clean": "b"})", "turb: must have no *"},
      {R"({"name": "n", "turb": 3, "clean": "b"})", "turb: must be a text"},
      {R"({"name": "n", "turb": "a", "clean": "b", "frames": -1})", "frames: must be a whole number"},
      {R"({"name": "n", "turb": "a", "clean": "b", "crop": 1})", "crop: there is no such key"}};
  for (const auto& [text, what] : cases) {
    const auto file = folder.Put("adapter.json", std::string(text));
    EXPECT_THAT(ErrorOf<std::invalid_argument>([&] { ReadAdapter(file); }),
                testing::AllOf(HasSubstr("adapter.json: "), HasSubstr(what)));
  }
}

// ---- Texts

Evaluation Small() {
  Evaluation evaluation{
      .set = "a, \"set\"",
      .variants = {{kInputName, VariantKind::kInput, ""}, {kFullName, VariantKind::kPipeline, ""}},
      .clips = {Clip("000000", 1, 1, 20, 23),
                Clip("000001", 2, {}, 21, std::numeric_limits<double>::infinity())},
      .real = {},
      .clips_of_set = 3};
  evaluation.clips[0].errors.push_back({"aof", "too, \"bad\""});
  return evaluation;
}

TEST(EvaluationTexts, WhatIsWrittenIsReadAgain) {
  const Evaluation evaluation = Small();
  for (const ClipResult& clip : evaluation.clips) {
    const nlohmann::json facts = nlohmann::json::parse(FactsJson(clip.facts).dump()),
                         rows = nlohmann::json::parse(RowsJson(clip.rows).dump());
    EXPECT_EQ(FactsJson(FactsOf(facts)), FactsJson(clip.facts));
    const auto again = RowsOf(rows);
    ASSERT_EQ(again.size(), clip.rows.size());
    for (size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].measures, clip.rows[i].measures);
  }
  EXPECT_FALSE(FactsOf(nlohmann::json::parse(FactsJson(evaluation.clips[1].facts).dump())).objects);
}

TEST(EvaluationTexts, ResultsHoldMeansAndGains) {
  const auto json = ResultsJson(Small());
  EXPECT_EQ(json.at("clips").size(), 2);
  EXPECT_EQ(json.at("clips")[0].at("errors")[0].at("error"), "too, \"bad\"");
  const auto& all = json.at("summary");
  const auto strong = std::ranges::find_if(
      all, [](const auto& each) { return each.at("value") == "medium" && each.at("variant") == "full"; });
  ASSERT_NE(strong, all.end());
  EXPECT_EQ(strong->at("means").at("psnr_db").at("mean"), 23);
  EXPECT_EQ(strong->at("gains_over_input").at("psnr_db").at("mean"), 3);
  EXPECT_EQ(json.at("clips")[1].at("rows")[1].at("psnr_db"), "inf");
}

TEST(EvaluationTexts, CsvHasARowAClipVariantAndStage) {
  const std::string csv = ResultsCsv(Small());
  std::vector<std::string> lines;
  for (size_t at = 0; at < csv.size();) {
    const size_t end = csv.find('\n', at);
    lines.push_back(csv.substr(at, end - at));
    at = end + 1;
  }
  ASSERT_EQ(lines.size(), 5);
  const auto commas = [](const std::string& line) { return std::ranges::count(line, ','); };
  for (const std::string& line : lines) EXPECT_EQ(commas(line), commas(lines[0])) << line;
  EXPECT_THAT(
      lines[0],
      HasSubstr("clip,kind,frames,width,height,tilt_rms_px,strength,shakes,objects,variant,stage,psnr_db,"));
  EXPECT_THAT(lines[1], HasSubstr("000000,truth,3,4,5,1,medium,no,1,input,result,20,"));
  EXPECT_THAT(lines[4], HasSubstr("000001,truth,3,4,5,2,strong,no,,full,result,inf,"));
}

}  // namespace
}  // namespace shimmer::restore::app
