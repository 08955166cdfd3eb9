// The page of an evaluation: the figures it shows, and what it does with what is odd or not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "restore/app/evaluation/pictures.h"
#include "restore/app/evaluation/report_page.h"
#include "restore/app/evaluation/report_pictures.h"
#include "tests/dataset/temp_folder.h"
#include "tests/restore/app/evaluation_page.h"
#include "tests/restore/app/evaluations.h"

namespace shimmer::restore::app {
namespace {

using dataset::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kInf = std::numeric_limits<double>::infinity();

std::string PageOf(const Evaluation& evaluation) { return EvaluationHtml(evaluation, "no such folder"); }

// Three clips, of gains 2, -1 and 5 dB.
Evaluation ThreeClips() {
  Evaluation evaluation = PlainEvaluation();
  evaluation.clips = {PlainClip("a", 20, 22), PlainClip("b", 30, 29), PlainClip("c", 25, 30)};
  evaluation.clips_of_set = 4;
  return evaluation;
}

TEST(EvaluationPage, ShowsMeansAndTheirMargins) {
  const std::string page = PageOf(ThreeClips());
  const PageTable variants = TableOf(page, "variants");
  EXPECT_THAT(variants.Texts("variant"), ElementsAre("input", "full pipeline"));
  EXPECT_EQ(variants.At(0, "psnr_db").number, "25");
  EXPECT_EQ(variants.At(1, "psnr_db").number, "27");
  EXPECT_EQ(variants.At(1, "psnr_db").text, "27.00");
  EXPECT_EQ(variants.At(0, "psnr_db_gain").number, "");
  EXPECT_EQ(variants.At(1, "psnr_db_gain").number, "2");
  EXPECT_EQ(variants.At(1, "psnr_db_gain").text, "+2.00 ±\u00A07.45");  // t(2) sqrt(9 / 3)
  EXPECT_EQ(variants.At(1, "ms_per_frame").number, "12.5");
  EXPECT_EQ(variants.At(1, "ssim").text, "–");
  EXPECT_EQ(variants.At(1, "ssim").number, "");
  EXPECT_THAT(page, HasSubstr("<b>3</b><span>of 4 clips evaluated</span>"));
  EXPECT_THAT(page,
              HasSubstr("<b>+2.00 dB</b><span>PSNR gain over the input, whole frame, ±\u00A07.45</span>"));
  EXPECT_THAT(page, HasSubstr("<b>-1.00 dB</b><span>gain of the worst clip, b</span>"));
  EXPECT_THAT(page, HasSubstr("<b>12.5 ms</b>"));
  EXPECT_THAT(page, Not(HasSubstr("mask IoU</span>")));  // of which there is none
}

TEST(EvaluationPage, SortsClipsWorstFirstAndThoseWithoutAGainLast) {
  Evaluation evaluation = ThreeClips();
  ClipResult failed = PlainClip("failed", 20, 0);
  failed.rows.pop_back();
  failed.errors = {{kFullName, "no <memory>"}};
  evaluation.clips.insert(evaluation.clips.begin(), failed);
  const std::string page = PageOf(evaluation);
  const PageTable clips = TableOf(page, "clips");
  EXPECT_THAT(clips.Texts("psnr_db_gain"), ElementsAre("-1.00", "+2.00", "+5.00", "–"));
  EXPECT_EQ(clips.At(0, "clip").text, "b");
  EXPECT_THAT(clips.At(3, "clip").text, HasSubstr("full: no &lt;memory&gt;"));
  EXPECT_THAT(SectionOf(page, "clips"), HasSubstr("data-key=\"psnr_db_gain\" aria-sort=\"ascending\""));
  const PageTable failures = TableOf(page, "failures");
  ASSERT_EQ(failures.rows.size(), 1u);
  EXPECT_EQ(failures.At(0, "variant").text, "full");
  EXPECT_EQ(failures.At(0, "error").text, "no &lt;memory&gt;");
  EXPECT_THAT(page, HasSubstr("<b>1</b><span>variant failed on some clip</span>"));
}

TEST(EvaluationPage, ShowsTheBestOfAColumnBoldAndNeverTheInput) {
  Evaluation evaluation = PlainEvaluation();
  evaluation.variants.push_back({"median", VariantKind::kBaseline, ""});
  ClipResult clip;
  clip.facts.name = "a";
  AddRow(clip, kInputName, kResultStage, {{Measure::kPsnr, 40}, {Measure::kStability, 1}});
  AddRow(clip, kFullName, kResultStage,
         {{Measure::kPsnr, 30}, {Measure::kStability, 3}, {Measure::kSsim, 0.9}});
  AddRow(clip, "median", kResultStage, {{Measure::kPsnr, 28}, {Measure::kStability, 2}});
  evaluation.clips = {clip};
  const PageTable variants = TableOf(PageOf(evaluation), "variants");
  const auto bold = [&](const std::string& key) {
    std::vector<bool> rows;
    for (size_t row = 0; row < 3; ++row) rows.push_back(variants.At(row, key).bold);
    return rows;
  };
  EXPECT_THAT(bold("psnr_db"), ElementsAre(false, true, false));
  EXPECT_THAT(bold("psnr_db_gain"), ElementsAre(false, true, false));
  EXPECT_THAT(bold("stability_levels"), ElementsAre(false, false, true));  // less is better
  EXPECT_THAT(bold("ssim"), ElementsAre(false, false, false));             // the only one is no best
  EXPECT_EQ(variants.At(1, "psnr_db_gain").text, "-10.00");                // of one clip no margin
}

TEST(EvaluationPage, ShowsStagesAndWhatTheyFound) {
  const std::string page = PageOf(LargeEvaluation(40));
  const PageTable stages = TableOf(page, "stages");
  EXPECT_THAT(stages.Texts("stage"), ElementsAre("input", "stabilise", "stack", "blend", "sharpen"));
  const double all = std::stod(stages.At(4, "psnr_db_gain").number);
  double sum = 0;
  for (size_t row = 1; row < 5; ++row) sum += std::stod(stages.At(row, "psnr_db_step").number);
  EXPECT_NEAR(sum, all, 1e-6);
  const std::string html = SectionOf(page, "stages");
  for (const char* found : {"tilt found", "its rank correlation", "shift error, max", "mask recall"})
    EXPECT_THAT(html, HasSubstr(found));
  for (const char* stage : {"look", "stabilise", "segment", "stack", "blend", "sharpen"})
    EXPECT_THAT(html, HasSubstr(std::string("data-stage=\"") + stage + "\""));
  EXPECT_THAT(html, HasSubstr("132.0 ms a frame in all"));
}

TEST(EvaluationPage, ShowsGroupsAndAPointAClip) {
  const Evaluation evaluation = LargeEvaluation(40);
  const std::string page = PageOf(evaluation), html = SectionOf(page, "groups");
  const PageTable groups = TableOf(page, "groups");
  EXPECT_THAT(groups.Texts("group"),
              ElementsAre("all clips", "strength: weak", "strength: medium", "strength: strong", "shake: no",
                          "shake: yes", "objects: 0", "objects: 1", "objects: 2", "objects: 3"));
  EXPECT_EQ(groups.At(0, "clips").number, "40");
  EXPECT_EQ(AllIn(html, "<circle class=\"clip\"").size(), 37u);  // three failed
  EXPECT_EQ(AllIn(html, "<polyline").size(), 7u);                // all but the input
  EXPECT_THAT(html, HasSubstr("<title>&lt;b&gt;&amp;&quot;: tilt "));
}

TEST(EvaluationPage, HoldsNoMarkupOfNames) {
  const std::string page = PageOf(LargeEvaluation(40));
  EXPECT_THAT(page, Not(HasSubstr(kMarkupName)));
  EXPECT_THAT(page, Not(HasSubstr("<unexpected>")));
  EXPECT_THAT(page, Not(HasSubstr("<i>chimney")));
  EXPECT_THAT(page, HasSubstr("<title>sets/&lt;b&gt;&amp;&quot;: evaluation</title>"));
}

TEST(EvaluationPage, ShowsWhatIsInfiniteAndWhatIsNoNumber) {
  Evaluation evaluation = PlainEvaluation();
  evaluation.clips = {PlainClip("perfect", 20, kInf), PlainClip("still", kInf, 30),
                      PlainClip("same", kInf, kInf), PlainClip("plain", 20, 21),
                      PlainClip("slight", 20, 19.9999)};
  for (ClipResult& clip : evaluation.clips) clip.facts.tilt_rms_px = 1;
  const std::string page = PageOf(evaluation);
  const PageTable clips = TableOf(page, "clips");
  EXPECT_THAT(clips.Texts("clip"), ElementsAre("still", "slight", "plain", "perfect", "same"));
  EXPECT_THAT(clips.Texts("psnr_db_gain"), ElementsAre("-inf", "0.00", "+1.00", "inf", "–"));
  EXPECT_EQ(clips.At(0, "psnr_db_gain").number, "-Infinity");
  EXPECT_EQ(clips.At(3, "psnr_db").number, "Infinity");
  EXPECT_EQ(clips.At(4, "psnr_db_gain").number, "");
  EXPECT_THAT(page, Not(HasSubstr("nan")));
  EXPECT_EQ(AllIn(SectionOf(page, "groups"), "<circle class=\"clip\"").size(), 2u);  // those with a place
}

TEST(EvaluationPage, OfNothingSaysSo) {
  const std::string page = PageOf(PlainEvaluation());
  EXPECT_THAT(page, HasSubstr("No clip is evaluated"));
  EXPECT_THAT(page, Not(HasSubstr("<section")));
  EXPECT_THAT(PageOf({}), HasSubstr("No clip is evaluated"));

  Evaluation failed = PlainEvaluation();
  ClipResult clip;
  clip.facts.name = "a";
  clip.errors = {{kInputName, "no file"}, {kFullName, "no file"}};
  failed.clips = {clip};
  const std::string all_failed = PageOf(failed);
  EXPECT_EQ(TableOf(all_failed, "failures").rows.size(), 2u);
  EXPECT_EQ(TableOf(all_failed, "variants").At(1, "clips").number, "0");
  EXPECT_THAT(all_failed, HasSubstr("No clip has both a known tilt and a gain."));
  EXPECT_EQ(SectionOf(PageOf(ThreeClips()), "failures"), "");
  EXPECT_EQ(SectionOf(PageOf(ThreeClips()), "real"), "");
}

TEST(EvaluationPage, OfRealVideoAloneShowsBeforeAndAfter) {
  Evaluation evaluation = PlainEvaluation();
  evaluation.set = "";
  evaluation.real = LargeEvaluation(1).real;
  const std::string page = PageOf(evaluation);
  EXPECT_EQ(SectionOf(page, "variants"), "");
  const PageTable real = TableOf(page, "real");
  ASSERT_EQ(real.rows.size(), 4u);
  EXPECT_EQ(real.At(0, "line_deviation_deg").number, "5.1");
  EXPECT_EQ(real.At(1, "line_deviation_deg_gain").text, "-1.90");
  EXPECT_EQ(real.At(1, "stability_levels").number, "2.5");
  EXPECT_EQ(real.At(1, "ms_per_frame").number, "140");
}

TEST(EvaluationPage, EmbedsThePicturesThatAreThere) {
  const TempFolder folder;
  Evaluation evaluation = ThreeClips();
  evaluation.real = {PlainClip("videos/../door.mp4", 1, 2)};
  folder.Put("pictures/a/input.jpg", "Man");
  folder.Put("pictures/a/result.jpg", "Ma");
  folder.Put("pictures/b/input.jpg", "Man");  // without a result
  folder.Put("pictures/c/input.jpg", "Man");
  folder.Put("pictures/c/result.jpg", "M");
  folder.Put("pictures/c/truth.jpg", "true");
  folder.Put("pictures/c/mask.jpg", "mask");
  folder.Put("pictures/c/rows_input.png", "rows");
  folder.Put("pictures/videos_.._door.mp4/input.jpg", "Man");
  folder.Put("pictures/videos_.._door.mp4/result.jpg", "Man");
  const std::string page = EvaluationHtml(evaluation, folder.path()), html = SectionOf(page, "pictures");
  const auto ids = AllIn(html, "<article class=\"clip\" id=\"([^\"]*)\">\\s*<h3>(\\w)");
  ASSERT_EQ(ids.size(), 2u);
  EXPECT_EQ(ids[0][2], "a");  // worse than c
  EXPECT_EQ(AllIn(html, "src=\"data:image/jpeg;base64,TWFu\"").size(), 2u);
  EXPECT_THAT(html, HasSubstr("data:image/jpeg;base64,TWE="));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,cm93cw=="));
  EXPECT_EQ(AllIn(html, "<button type=\"button\" data-view").size(), 3u);  // of a there is nothing to choose
  EXPECT_EQ(AllIn(SectionOf(page, "clips"), "<a href=\"#clip-\\d+\">").size(), 2u);
  EXPECT_THAT(SectionOf(page, "real"), HasSubstr("<article class=\"clip\" id=\"real-1\">"));
  EXPECT_EQ(AllIn(page, "(src|href)=\"(?!data:|#)").size(), 0u);  // nothing from elsewhere
}

TEST(EvaluationPage, ShowsNoMoreClipsThanItMay) {
  const TempFolder folder;
  Evaluation evaluation = PlainEvaluation();
  for (int i = 0; i < 20; ++i) {
    evaluation.clips.push_back(PlainClip("c" + std::to_string(i), 20, 40 - i));
    folder.Put("pictures/c" + std::to_string(i) + "/input.jpg", "in");
    folder.Put("pictures/c" + std::to_string(i) + "/result.jpg", "out");
  }
  const std::string html = SectionOf(EvaluationHtml(evaluation, folder.path()), "pictures");
  EXPECT_EQ(AllIn(html, "<article").size(), kClipsShown);
  EXPECT_THAT(html, HasSubstr("<h3>c19 "));
  EXPECT_THAT(html, HasSubstr("<h3>c8 "));
  EXPECT_THAT(html, Not(HasSubstr("<h3>c7 ")));
}

TEST(EvaluationPage, PicturesHaveAFolderEachInTheirOwn) {
  EXPECT_EQ(PicturesOf("r", "000012"), "r/pictures/000012");
  EXPECT_EQ(PicturesOf("r", "/videos/door.mp4"), "r/pictures/_videos_door.mp4");
  EXPECT_EQ(PicturesOf("r", ".."), "r/pictures/_..");
  EXPECT_EQ(PicturesOf("r", ""), "r/pictures/_");
}

}  // namespace
}  // namespace shimmer::restore::app
