#include "cli/page.h"
#include "restore/app/evaluation/report_charts.h"
#include "restore/app/evaluation/report_table.h"
#include "restore/app/evaluation/report_tables.h"

namespace shimmer::restore::app {
namespace {

// After the gain.
constexpr Measure kOtherMeasures[] = {Measure::kPsnrBackground, Measure::kPsnrForeground, Measure::kPsnrBox,
                                      Measure::kLineDeviation,  Measure::kStability,      Measure::kTime};

std::string GroupName(const ClipGroup& group) {
  return group.key == "all" ? "all clips" : group.key + ": " + group.value;
}

}  // namespace

std::string VariantsHtml(const Evaluation& evaluation) {
  std::vector<Column> columns = {TextColumn("variant", "variant"), CountColumn("clips", "clips"),
                                 ColumnOf(Measure::kPsnr), ColumnOf(Measure::kSsim),
                                 GainColumn(Measure::kPsnr, "gain over the input")};
  for (const Measure measure : kOtherMeasures) columns.push_back(ColumnOf(measure));
  Table table("Variants", columns);
  const ClipGroup all = AllOf(evaluation.clips);
  for (const VariantText& variant : evaluation.variants) {
    const auto mean = [&](Measure measure, bool gain = false) {
      return MeanIn(all, variant.name, kResultStage, measure, gain);
    };
    const bool input = variant.kind == VariantKind::kInput;
    int64_t clips = 0;
    for (const ClipResult* clip : all.clips) clips += FindRow(*clip, variant.name) != nullptr;
    const std::string kind = variant.name == NameOf(variant.kind) ? "" : NameOf(variant.kind);
    std::vector<Cell> cells = {
        {.text = variant.name,
         .small = kind + (kind.empty() || variant.settings.empty() ? "" : ", ") + variant.settings},
        CountCell(clips),
        MeanCell(mean(Measure::kPsnr), Measure::kPsnr),
        MeanCell(mean(Measure::kSsim), Measure::kSsim),
        input ? Cell{.text = kAbsent} : MeanCell(mean(Measure::kPsnr, true), Measure::kPsnr, Sign::kAlways)};
    for (const Measure measure : kOtherMeasures) cells.push_back(MeanCell(mean(measure), measure));
    table.Add(cells, !input);
  }
  return cli::Section("variants", "Variants",
                      "Means over the clips that a variant did not fail on; ± is half of the 95 % confidence "
                      "interval. Bold is the best of a column, the input left out.",
                      table.Html());
}

std::string GroupsHtml(const Evaluation& evaluation) {
  Column input = ColumnOf(Measure::kPsnr), full = input;
  input.key = "psnr_db_input";
  input.label = "PSNR, input";
  full.label = "PSNR, restored";
  Table table("Groups of clips",
              {TextColumn("group", "group"), CountColumn("clips", "clips"), input, full,
               GainColumn(Measure::kPsnr, "gain"), GainColumn(Measure::kPsnrBackground, "gain, background"),
               GainColumn(Measure::kPsnrForeground, "gain, foreground"), ColumnOf(Measure::kSsim),
               ColumnOf(Measure::kIou), ColumnOf(Measure::kShiftMean)});
  for (const ClipGroup& group : GroupsOf(evaluation.clips)) {
    const auto cell = [&](const char* variant, Measure measure, bool gain = false) {
      return MeanCell(MeanIn(group, variant, kResultStage, measure, gain), measure,
                      gain ? Sign::kAlways : Sign::kOfNegative);
    };
    table.Add({{.text = GroupName(group)},
               CountCell(std::ssize(group.clips)),
               cell(kInputName, Measure::kPsnr),
               cell(kFullName, Measure::kPsnr),
               cell(kFullName, Measure::kPsnr, true),
               cell(kFullName, Measure::kPsnrBackground, true),
               cell(kFullName, Measure::kPsnrForeground, true),
               cell(kFullName, Measure::kSsim),
               MeanCell(MeanFound(group, Measure::kIou), Measure::kIou),
               MeanCell(MeanFound(group, Measure::kShiftMean), Measure::kShiftMean)},
              false);
  }
  return cli::Section("groups", "By strength, shake, objects",
                      "The full pipeline. Weak is a tilt below 0.71 px, medium below 1.41 px, RMS along an "
                      "axis; gains are over the input.",
                      table.Html() + QualityChartHtml(evaluation));
}

}  // namespace shimmer::restore::app
