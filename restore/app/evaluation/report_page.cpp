#include "restore/app/evaluation/report_page.h"

#include "cli/number_text.h"
#include "cli/page.h"
#include "cli/report_style.h"
#include "restore/app/evaluation/report_clips.h"
#include "restore/app/evaluation/report_head.h"
#include "restore/app/evaluation/report_look.h"
#include "restore/app/evaluation/report_numbers.h"
#include "restore/app/evaluation/report_script.h"
#include "restore/app/evaluation/report_tables.h"

namespace shimmer::restore::app {
namespace {

constexpr const char* kFoot =
    "<footer>\n<p>PSNR and SSIM are means over frames, on all pixels that the camera saw. The foreground is "
    "where the true mask is at least half, the background what else there is, the box the smallest rectangle "
    "around the foreground. A gain is over the turbulent input, which for a clip that shakes is moved by the "
    "true shake.</p>\n<p>Line deviation and stability are of the frames alone: how far straight edges are "
    "from upright and level, and how much pixels that do not move change from frame to frame; of both, less "
    "is "
    "better. A value that is not defined is –, one that is infinite inf: frames that are equal to the "
    "true ones.</p>\n<p>What is measured, and how: docs/evaluation.md.</p>\n</footer>\n";

std::string PicturesHtml(const std::vector<ShownClip>& shown, size_t clips) {
  if (shown.empty()) return cli::Section("pictures", "Pictures", "There are none of these clips.", "");
  return cli::Section("pictures", "Pictures",
                      (shown.size() < clips ? "The worst " + cli::Counted(std::ssize(shown), "clip") +
                                                  " of those with pictures; the middle frame of each."
                                            : "The middle frame of each clip, the worst first.") +
                          " Drag the line, or move it with the arrow keys.",
                      ShownClipsHtml(shown));
}

std::string ClipParts(const Evaluation& evaluation, const std::filesystem::path& folder) {
  if (evaluation.clips.empty()) return "";
  const std::vector<ShownClip> shown = ClipsToShow(WorstFirst(evaluation.clips), folder, "clip-");
  return VariantsHtml(evaluation) + StagesHtml(evaluation) + GroupsHtml(evaluation) +
         ClipsHtml(evaluation, shown) + PicturesHtml(shown, evaluation.clips.size());
}

std::string RealParts(const Evaluation& evaluation, const std::filesystem::path& folder) {
  if (evaluation.real.empty()) return "";
  return RealHtml(evaluation, ClipsToShow(AllOf(evaluation.real).clips, folder, "real-"));
}

}  // namespace

std::string EvaluationHtml(const Evaluation& evaluation, const std::filesystem::path& folder) {
  const std::string name = evaluation.set.empty() ? "Real video" : evaluation.set;
  std::string html = cli::PageStart(name + ": evaluation", std::string(cli::kReportStyle) + kReportLook) +
                     HeadHtml(evaluation);
  if (evaluation.clips.empty() && evaluation.real.empty())
    html += "<p class=\"empty\">No clip is evaluated: there is nothing to show yet.</p>\n";
  return html + ClipParts(evaluation, folder) + RealParts(evaluation, folder) + FailuresHtml(evaluation) +
         kFoot + "<script>" + kReportScript + "</script>\n</body>\n</html>\n";
}

}  // namespace shimmer::restore::app
