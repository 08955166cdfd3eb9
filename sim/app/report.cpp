#include "sim/app/report.h"
#include "sim/dataset/dataset_folder.h"

#include <algorithm>
#include <iterator>

#include "cli/html.h"
#include "cli/number_text.h"
#include "cli/page.h"
#include "cli/report_style.h"
#include "sim/app/job.h"
#include "sim/app/preview.h"
#include "sim/app/report_charts.h"
#include "sim/app/report_drawn.h"
#include "sim/app/report_facts.h"
#include "sim/app/report_summary.h"

namespace shimmer::app {
namespace {

constexpr int kSheetRows = 6, kJpegQuality = 88;
constexpr int64_t kMostErrors = 200;

std::string Charts(const std::string& charts) { return "<div class=\"charts\">\n" + charts + "</div>\n"; }

std::string MarksNote(const std::vector<std::string>& truth) {
  std::string note;
  if (std::ranges::count(truth, "mask") > 0)
    note += " Green lines are the edges of moving objects, by the masks.";
  if (std::ranges::count(truth, "shake") > 0)
    note += " The inset is the path of a camera that shakes; the dot is its place in this frame.";
  return note;
}

std::string SheetHtml(const dataset::DatasetReader& reader, const std::vector<std::string>& truth) {
  const cv::Mat sheet = ContactSheet(reader, kSheetRows);
  const std::string size =
      "width=\"" + std::to_string(sheet.cols) + "\" height=\"" + std::to_string(sheet.rows) + "\"";
  return cli::Section(
      "sheet", "Contact sheet",
      "The middle frame of clips that are spread evenly over the set. Tilt: hue is direction, "
      "saturation is length." +
          MarksNote(truth),
      "<div class=\"sheet\" tabindex=\"0\"><img alt=\"Clean frames, turbulent frames, tilt and "
      "sigma of some clips, side by side\" " +
          size + " src=\"data:image/jpeg;base64," + cli::Base64(dataset::EncodeJpeg(sheet, kJpegQuality)) +
          "\"></div>\n");
}

std::string MeasuredHtml(const ReportFacts& facts) {
  std::string motion;
  if (!facts.shake_rms_px.numbers.empty())
    motion += HistogramHtml({"shake_rms_px", "px", {"RMS of the camera's shift off its first place"}},
                            facts.shake_rms_px.numbers, cli::AxisKind::kLinear);
  if (!facts.moving_share.numbers.empty())
    motion += HistogramHtml({"moving_share", "", {"share of the frame that moving objects cover, mean"}},
                            facts.moving_share.numbers, cli::AxisKind::kLinear);
  return cli::Section("measured", motion.empty() ? "Tilt RMS and sigma" : "Tilt RMS, sigma and motion",
                      "One value a clip, over all pixels of the frames that were written.",
                      Charts(HistogramHtml({"tilt_rms_px", "px", {"RMS of the shift along an axis"}},
                                           facts.tilt_rms_px.numbers, cli::AxisKind::kLinear) +
                             HistogramHtml({"mean_sigma_px", "px", {"mean of the blur's sigma"}},
                                           facts.mean_sigma_px.numbers, cli::AxisKind::kLinear) +
                             motion));
}

std::string DrawnHtml(const ConfigFile& config, const ReportFacts& facts) {
  const std::string charts = DrawnChartsHtml(config, facts);
  if (charts.empty())
    return cli::Section("drawn", "Drawn parameters", "None: every clip has the same values.", "");
  return cli::Section("drawn", "Drawn parameters",
                      "Each clip has drawn its own value; these are of the clips done.", Charts(charts));
}

std::string SourcesHtml(const Json& sources, const ReportFacts& facts) {
  if (facts.clips_of_source.empty()) return "";  // drawn scenes
  std::vector<BarRow> rows;
  for (const auto& [path, clips] : facts.clips_of_source) rows.push_back({path, clips});
  std::ranges::stable_sort(rows, std::ranges::greater(), &BarRow::count);
  const SourceCounts counts = CountSources(sources);
  const std::string others = counts.masks_and_objects == 0
                                 ? ""
                                 : " The set is made from these and " +
                                       cli::Counted(counts.masks_and_objects, "file") +
                                       " of masks and objects.";
  return cli::Section("sources", "Sources",
                      cli::Grouped(std::ssize(rows)) + " of " +
                          cli::Counted(counts.backgrounds, "source file") +
                          (rows.size() == 1 ? " is" : " are") + " seen in clips that are done." + others,
                      BarsHtml({"source.path", "", {"clips that show it"}}, rows));
}

std::string FailureRow(const std::string& error, const Failure& failure) {
  std::string which;
  for (const int64_t clip : failure.first_clips) which += (which.empty() ? "" : ", ") + std::to_string(clip);
  const int64_t more = failure.clips - std::ssize(failure.first_clips);
  if (more > 0) which += " and " + cli::Grouped(more) + " more";
  return "<tr data-clips=\"" + std::to_string(failure.clips) + "\"><td>" + cli::EscapeHtml(error) +
         "</td><td class=\"count\">" + cli::Grouped(failure.clips) + "</td><td>" + which + "</td></tr>\n";
}

std::string FailuresHtml(const ReportFacts& facts) {
  if (facts.failures.empty()) return cli::Section("failures", "Failures", "No clip has failed.", "");
  std::vector<std::pair<std::string, Failure>> failures(facts.failures.begin(), facts.failures.end());
  std::ranges::stable_sort(failures, std::ranges::greater(), [](const auto& f) { return f.second.clips; });
  const int64_t shown = std::min(std::ssize(failures), kMostErrors);
  int64_t clips = 0, shown_clips = 0;
  std::string rows;
  for (int64_t i = 0; i < std::ssize(failures); ++i) {
    const auto& [error, failure] = failures[i];
    clips += failure.clips;
    if (i >= shown) continue;
    rows += FailureRow(error, failure);
    shown_clips += failure.clips;
  }
  if (clips > shown_clips)
    rows += "<tr data-clips=\"" + std::to_string(clips - shown_clips) + "\"><td>" +
            cli::EscapeHtml("and " + cli::Counted(std::ssize(failures) - shown, "other error")) +
            "</td><td class=\"count\">" + cli::Grouped(clips - shown_clips) + "</td><td></td></tr>\n";
  return cli::Section(
      "failures", "Failures",
      cli::Counted(clips, "clip") + " could not be made; their lines in the manifest have the error.",
      "<table class=\"failures\">\n<tr><th scope=\"col\">Error</th><th scope=\"col\" class=\"count\">"
      "Clips</th><th scope=\"col\">Which</th></tr>\n" +
          rows + "</table>\n");
}

}  // namespace

std::string ReportHtml(const std::filesystem::path& folder) {
  const dataset::DatasetReader reader(folder);
  const ConfigFile config = ConfigOfDataset(folder, reader.description());
  const ReportFacts facts = FactsOf(reader);
  std::string html = cli::PageStart(config.fixed().output.name + ": report", cli::kReportStyle) +
                     SummaryHtml(reader, config, facts);
  if (reader.clips().empty())
    html += "<p class=\"empty\">No clip is done: there is nothing to show yet.</p>\n";
  else
    html += SheetHtml(reader, config.fixed().output.truth) + MeasuredHtml(facts) + DrawnHtml(config, facts) +
            SourcesHtml(reader.description().value("sources", Json::array()), facts);
  return html + FailuresHtml(facts) + "<details>\n<summary>Config</summary>\n<pre>" +
         cli::EscapeHtml(config.resolved().dump(2)) + "</pre>\n</details>\n</body>\n</html>\n";
}

std::filesystem::path WriteReport(const std::filesystem::path& folder) {
  const std::string html = ReportHtml(folder);
  dataset::WriteDatasetFile(folder, kReportName, dataset::AsBytes(html));
  return folder / kReportName;
}

}  // namespace shimmer::app
