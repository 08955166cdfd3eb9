#include "cli/page.h"
#include "restore/app/evaluation/report_charts.h"
#include "restore/app/evaluation/report_table.h"
#include "restore/app/evaluation/report_tables.h"

namespace shimmer::restore::app {
namespace {

constexpr Measure kScores[] = {Measure::kPsnr,           Measure::kSsim,    Measure::kPsnrBackground,
                               Measure::kPsnrForeground, Measure::kPsnrBox, Measure::kLineDeviation,
                               Measure::kStability};

// Whose frames a row of the table is of.
struct Step {
  std::string variant, stage;
};

bool HasScores(const ClipGroup& all, const Step& step) {
  for (const Measure measure : kScores)
    if (MeanIn(all, step.variant, step.stage, measure, false)) return true;
  return false;
}

// The mean of how much more PSNR a step has than the one before, clip by clip.
std::optional<MeanOfClips> MeanStep(const ClipGroup& all, const Step& before, const Step& step) {
  std::vector<Value> gains;
  for (const ClipResult* clip : all.clips) {
    const ResultRow* from = FindRow(*clip, before.variant, before.stage);
    const ResultRow* to = FindRow(*clip, step.variant, step.stage);
    if (from && to && from->measures[Measure::kPsnr] && to->measures[Measure::kPsnr])
      gains.push_back(*to->measures[Measure::kPsnr] - *from->measures[Measure::kPsnr]);
  }
  return MeanOf(gains);
}

Table ScoresTable(const ClipGroup& all) {
  Column before{"psnr_db_step", "over the stage before", "dB"};
  std::vector<Column> columns = {TextColumn("stage", "stage"),
                                 GainColumn(Measure::kPsnr, "gain over the input"), before};
  for (const Measure measure : kScores) columns.push_back(ColumnOf(measure));
  Table table("Stages", columns);
  Step last{kInputName, kResultStage};
  const auto add = [&](const std::string& name, const Step& step) {
    const bool input = step.variant == kInputName;
    std::vector<Cell> cells = {{.text = name}, {.text = kAbsent}, {.text = kAbsent}};
    if (!input) {
      cells[1] = MeanCell(MeanIn(all, step.variant, step.stage, Measure::kPsnr, true), Measure::kPsnr,
                          Sign::kAlways);
      cells[2] = MeanCell(MeanStep(all, last, step), Measure::kPsnr, Sign::kAlways);
    }
    for (const Measure measure : kScores)
      cells.push_back(MeanCell(MeanIn(all, step.variant, step.stage, measure, false), measure));
    table.Add(cells, !input);
    last = step;
  };
  if (HasScores(all, last)) add("input", last);
  for (const char* stage : kStageNames)
    if (const Step step{kFullName, stage}; HasScores(all, step)) add(stage, step);
  return table;
}

struct Finding {
  const char* stage;
  Measure measure;
};
constexpr Finding kFindings[] = {{"look", Measure::kFoundTilt},     {"stabilise", Measure::kShiftMean},
                                 {"stabilise", Measure::kShiftP95}, {"stabilise", Measure::kShiftMost},
                                 {"segment", Measure::kIou},        {"segment", Measure::kPrecision},
                                 {"segment", Measure::kRecall}};

// The clip that is worst by a measure, or null.
const ClipResult* WorstBy(const ClipGroup& all, Measure measure) {
  const ClipResult* worst = nullptr;
  for (const ClipResult* clip : all.clips) {
    const Value value = Found(*clip, measure);
    if (!value || TextOf(measure).better == Better::kNeither) continue;
    const double other = worst ? *Found(*worst, measure) : *value;
    if (!worst || (TextOf(measure).better == Better::kLess ? *value > other : *value < other)) worst = clip;
  }
  return worst;
}

Table FindingsTable(const Evaluation& evaluation, const ClipGroup& all) {
  Table table("What the stages found",
              {TextColumn("stage", "stage"), TextColumn("measure", "measure"), CountColumn("mean", "mean"),
               CountColumn("margin", "± 95 %"), CountColumn("worst", "worst"), TextColumn("clip", "of clip"),
               CountColumn("clips", "clips")});
  for (const auto& [stage, measure] : kFindings) {
    const MeasureText& text = TextOf(measure);
    const std::optional<MeanOfClips> mean = MeanFound(all, measure);
    if (!mean) continue;
    const ClipResult* worst = WorstBy(all, measure);
    table.Add({{.text = stage},
               {.text = text.label, .small = text.unit},
               NumberCell(mean->mean, text.decimals),
               NumberCell(mean->margin, text.decimals),
               NumberCell(worst ? Found(*worst, measure) : Value(), text.decimals),
               {.text = worst ? worst->facts.name : kAbsent},
               CountCell(mean->clips)});
    const Value correlation = measure == Measure::kFoundTilt ? TiltCorrelation(evaluation.clips) : Value();
    if (correlation)
      table.Add({{.text = stage},
                 {.text = "its rank correlation with the true tilt"},
                 NumberCell(correlation, 3),
                 {.text = kAbsent},
                 {.text = kAbsent},
                 {.text = kAbsent},
                 {.text = kAbsent}});
  }
  return table;
}

}  // namespace

std::string StagesHtml(const Evaluation& evaluation) {
  const ClipGroup all = AllOf(evaluation.clips);
  const Table scores = ScoresTable(all), found = FindingsTable(evaluation, all);
  std::string html = scores.empty() ? "" : scores.Html();
  if (!found.empty()) html += "<h3>What the stages found</h3>\n" + found.Html();
  return cli::Section("stages", "Stage by stage",
                      "The full pipeline, as its frames come out of each stage, against the same truth.",
                      html + StageTimesHtml(all));
}

}  // namespace shimmer::restore::app
