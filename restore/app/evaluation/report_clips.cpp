#include "restore/app/evaluation/report_clips.h"

#include <algorithm>
#include <limits>

#include "cli/page.h"
#include "restore/app/evaluation/report_table.h"

namespace shimmer::restore::app {
namespace {

Value MeasureOf(const ClipResult& clip, const std::string& variant, Measure measure) {
  const ResultRow* row = FindRow(clip, variant);
  return row ? row->measures[measure] : Value();
}

Cell LevelCell(const Value& value, Measure measure) { return NumberCell(value, TextOf(measure).decimals); }

Cell GainCell(const Value& gain, Measure measure) {
  return NumberCell(gain, TextOf(measure).decimals, Sign::kAlways);
}

// Sorted by the count of px.
Cell SizeCell(const cv::Size& size) {
  if (size.empty()) return {.text = kAbsent};
  return {.text = std::to_string(size.width) + "x" + std::to_string(size.height),
          .value = static_cast<double>(size.width) * size.height};
}

std::string LinkOf(const ClipResult& clip, const std::vector<ShownClip>& shown) {
  const auto found = std::ranges::find(shown, &clip, &ShownClip::clip);
  return found == shown.end() ? "" : "#" + found->id;
}

Cell NameCell(const ClipResult& clip, const std::vector<ShownClip>& shown) {
  std::string errors;
  for (const VariantError& error : clip.errors)
    errors += (errors.empty() ? "" : "; ") + error.variant + ": " + error.error;
  return {.text = clip.facts.name, .link = LinkOf(clip, shown), .error = errors};
}

Column Renamed(Column column, const std::string& key, const std::string& label) {
  column.key = key;
  column.label = label;
  return column;
}

}  // namespace

std::vector<const ClipResult*> WorstFirst(const std::vector<ClipResult>& clips) {
  std::vector<const ClipResult*> sorted = AllOf(clips).clips;
  std::ranges::stable_sort(sorted, {}, [](const ClipResult* clip) {
    const Value gain = FullGain(*clip);
    return std::pair(!gain, gain.value_or(0));
  });
  return sorted;
}

std::string ClipsHtml(const Evaluation& evaluation, const std::vector<ShownClip>& shown) {
  const Column psnr = ColumnOf(Measure::kPsnr);
  Table table(
      "Clips",
      {TextColumn("clip", "clip"), GainColumn(Measure::kPsnr, "gain"),
       GainColumn(Measure::kPsnrBackground, "gain, background"),
       GainColumn(Measure::kPsnrForeground, "gain, foreground"),
       Renamed(psnr, "psnr_db_input", "PSNR, input"), Renamed(psnr, psnr.key, "PSNR, restored"),
       ColumnOf(Measure::kSsim), ColumnOf(Measure::kIou),
       Renamed(ColumnOf(Measure::kShiftP95), TextOf(Measure::kShiftP95).name, "shift error, p95"),
       ColumnOf(Measure::kTime), CountColumn("tilt", "true tilt", "px"), TextColumn("shake", "shake"),
       CountColumn("objects", "objects"), CountColumn("size", "size", "px"), CountColumn("frames", "frames")},
      "psnr_db_gain");
  for (const ClipResult* clip : WorstFirst(evaluation.clips)) {
    const ClipFacts& facts = clip->facts;
    const auto level = [&](Measure measure) {
      return LevelCell(MeasureOf(*clip, kFullName, measure), measure);
    };
    const auto gain = [&](Measure measure) { return GainCell(GainOf(*clip, kFullName, measure), measure); };
    Cell tilt = NumberCell(facts.tilt_rms_px, 2);
    tilt.small = StrengthOf(facts);
    table.Add({NameCell(*clip, shown),
               gain(Measure::kPsnr),
               gain(Measure::kPsnrBackground),
               gain(Measure::kPsnrForeground),
               LevelCell(MeasureOf(*clip, kInputName, Measure::kPsnr), Measure::kPsnr),
               level(Measure::kPsnr),
               level(Measure::kSsim),
               LevelCell(Found(*clip, Measure::kIou), Measure::kIou),
               LevelCell(Found(*clip, Measure::kShiftP95), Measure::kShiftP95),
               level(Measure::kTime),
               tilt,
               {.text = !facts.shakes   ? kAbsent
                        : *facts.shakes ? "yes"
                                        : "no"},
               facts.objects ? CountCell(*facts.objects) : Cell{.text = kAbsent},
               SizeCell(facts.size),
               CountCell(facts.frames)},
              false);
  }
  return cli::Section("clips", "Clips, worst first",
                      "The full pipeline, by its PSNR gain over the input on the whole frame. A clip's name "
                      "leads to its pictures, where they are shown.",
                      table.Html());
}

std::string RealHtml(const Evaluation& evaluation, const std::vector<ShownClip>& shown) {
  constexpr Measure kAlone[] = {Measure::kLineDeviation, Measure::kStability};
  std::vector<Column> columns = {TextColumn("clip", "video"), TextColumn("variant", "variant")};
  for (const Measure measure : kAlone) {
    columns.push_back(ColumnOf(measure));
    columns.push_back(GainColumn(measure, "over the input"));
    columns[columns.size() - 2].best = columns.back().best = Better::kNeither;  // videos differ
  }
  columns.push_back(ColumnOf(Measure::kTime));
  columns.push_back(CountColumn("size", "size", "px"));
  columns.push_back(CountColumn("frames", "frames"));
  Table table("Real video", columns);
  for (const ClipResult& clip : evaluation.real) {
    Cell name = NameCell(clip, shown);
    const auto add = [&](const std::string& variant) {
      std::vector<Cell> cells = {name, {.text = variant}};
      for (const Measure measure : kAlone) {
        cells.push_back(LevelCell(MeasureOf(clip, variant, measure), measure));
        cells.push_back(variant == kInputName ? Cell{.text = kAbsent}
                                              : GainCell(GainOf(clip, variant, measure), measure));
      }
      cells.push_back(LevelCell(MeasureOf(clip, variant, Measure::kTime), Measure::kTime));
      cells.push_back(SizeCell(clip.facts.size));
      cells.push_back(CountCell(clip.facts.frames));
      table.Add(cells, false);
      name.error.clear();  // once a video
    };
    int rows = 0;
    for (const VariantText& variant : evaluation.variants)
      if (FindRow(clip, variant.name)) add(variant.name), ++rows;
    if (rows == 0) add(kAbsent);
  }
  return cli::Section("real", "Real video",
                      "Of these no truth is known: straight lines should be straighter and the picture "
                      "steadier than the input's.",
                      table.Html() + ShownClipsHtml(shown));
}

std::string FailuresHtml(const Evaluation& evaluation) {
  Table table("Failures",
              {TextColumn("clip", "clip"), TextColumn("variant", "variant"), TextColumn("error", "error")});
  for (const auto* clips : {&evaluation.clips, &evaluation.real})
    for (const ClipResult& clip : *clips)
      for (const VariantError& error : clip.errors)
        table.Add({{.text = clip.facts.name}, {.text = error.variant}, {.text = "", .error = error.error}});
  if (table.empty()) return "";
  return cli::Section("failures", "Failures", "What failed on a clip is in no mean; the other variants are.",
                      table.Html());
}

}  // namespace shimmer::restore::app
