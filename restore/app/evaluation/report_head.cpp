#include "restore/app/evaluation/report_head.h"

#include <set>

#include "cli/html.h"
#include "cli/number_text.h"
#include "cli/page.h"
#include "restore/app/evaluation/report_clips.h"
#include "restore/app/evaluation/report_numbers.h"

namespace shimmer::restore::app {
namespace {

// Variants that failed on a clip at least.
size_t FailedVariants(const Evaluation& evaluation) {
  std::set<std::string> failed;
  for (const auto* clips : {&evaluation.clips, &evaluation.real})
    for (const ClipResult& clip : *clips)
      for (const VariantError& error : clip.errors) failed.insert(error.variant);
  return failed.size();
}

// Nothing where no clip has the figure.
std::string MeanTile(const std::string& name, const std::optional<MeanOfClips>& mean, Measure measure,
                     Sign sign = Sign::kOfNegative) {
  if (!mean) return "";
  const MeasureText& text = TextOf(measure);
  const std::string margin = MarginText(mean, text.decimals);
  return cli::Tile(name + (margin.empty() ? "" : ", " + margin), ShownWithUnit(mean->mean, text, sign));
}

std::string HeadlineTiles(const Evaluation& evaluation) {
  const ClipGroup all = AllOf(evaluation.clips);
  const auto gain = [&](const std::string& name, Measure measure) {
    return MeanTile(name, MeanIn(all, kFullName, kResultStage, measure, true), measure, Sign::kAlways);
  };
  std::string tiles = gain("PSNR gain over the input, whole frame", Measure::kPsnr) +
                      gain("gain on the background", Measure::kPsnrBackground) +
                      gain("gain on the foreground", Measure::kPsnrForeground);
  if (!all.clips.empty())
    if (const ClipResult& worst = *WorstFirst(evaluation.clips).front(); FullGain(worst))
      tiles += cli::Tile("gain of the worst clip, " + worst.facts.name,
                         ShownWithUnit(FullGain(worst), TextOf(Measure::kPsnr), Sign::kAlways));
  tiles += MeanTile("mask IoU", MeanFound(all, Measure::kIou), Measure::kIou) +
           MeanTile("shift error, mean", MeanFound(all, Measure::kShiftMean), Measure::kShiftMean);
  if (const std::optional<double> correlation = TiltCorrelation(evaluation.clips))
    tiles += cli::Tile("rank correlation of the tilt found with the true one", Shown(*correlation, 2));
  if (const auto time = MeanIn(all, kFullName, kResultStage, Measure::kTime, false))
    tiles += cli::Tile("a frame, in all stages", Shown(time->mean, TextOf(Measure::kTime).decimals) + " ms");
  return tiles;
}

}  // namespace

std::string HeadHtml(const Evaluation& evaluation) {
  const int64_t clips = std::ssize(evaluation.clips), real = std::ssize(evaluation.real);
  std::string what = cli::Counted(std::ssize(evaluation.variants), "variant");
  if (real > 0) what += ", " + cli::Counted(real, "real video");
  std::string tiles;
  if (!evaluation.set.empty())
    tiles +=
        cli::Tile("of " + cli::Counted(evaluation.clips_of_set, "clip") + " evaluated", cli::Grouped(clips));
  if (const auto failed = static_cast<int64_t>(FailedVariants(evaluation)); failed > 0)
    tiles += cli::Tile(failed == 1 ? "variant failed on some clip" : "variants failed on some clip",
                       cli::Grouped(failed), true);
  return "<header>\n<p class=\"kind\">Unshimmer evaluation</p>\n<h1>" +
         cli::EscapeHtml(evaluation.set.empty() ? "Real video" : evaluation.set) +
         "</h1>\n<p class=\"quiet\">" + cli::EscapeHtml(what) + "</p>\n</header>\n<div class=\"tiles\">\n" +
         tiles + HeadlineTiles(evaluation) + "</div>\n";
}

}  // namespace shimmer::restore::app
