#include "restore/app/evaluation/report_pictures.h"

#include <algorithm>

#include "cli/html.h"
#include "cli/number_text.h"
#include "restore/app/evaluation/pictures.h"
#include "restore/app/evaluation/report_numbers.h"
#include "sim/dataset/files.h"

namespace shimmer::restore::app {
namespace {

using cli::EscapeHtml;

constexpr double kMostWidth_px = 720, kMostHeight_px = 560;  // as the page shows them

// What may be seen on the right of the line.
struct View {
  const char *name, *file, *label, *what;
};
constexpr View kViews[] = {{"result", kResultPicture, "restored", "restored"},
                           {"truth", kTruthPicture, "true", "true"},
                           {"mask", kMaskPicture, "masks", "restored, with outlines of masks,"}};
constexpr View kRows[] = {{"input", kInputRows, "turbulent", "turbulent"},
                          {"result", kResultRows, "restored", "restored"},
                          {"truth", kTruthRows, "true", "true"}};

bool IsThere(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) > 0;
}

std::string ImageHtml(const std::filesystem::path& file, const std::string& alt,
                      const std::string& more_html) {
  const std::string kind = file.extension() == ".png" ? "png" : "jpeg";
  return "<img " + more_html + " alt=\"" + EscapeHtml(alt) + "\" draggable=\"false\" src=\"data:image/" +
         kind + ";base64," + cli::Base64(dataset::ReadFile(file)) + "\">";
}

// No wider than the picture is of use, and no higher than a window.
std::string WidthOf(const cv::Size& size) {
  if (size.empty()) return "";
  const double width = std::min(kMostWidth_px, kMostHeight_px * size.width / size.height);
  return " style=\"max-width:" + std::to_string(static_cast<int>(width)) + "px\"";
}

// Without a script it shows the result, and neither the line nor the buttons.
std::string SliderHtml(const ShownClip& shown) {
  const std::string& name = shown.clip->facts.name;
  std::string images, buttons;
  int views = 0;
  for (const View& view : kViews) {
    if (!IsThere(shown.folder / view.file)) continue;
    const std::string chosen = views == 0 ? "true" : "false",
                      data = std::string("data-view=\"") + view.name + "\"";
    images += ImageHtml(shown.folder / view.file, std::string("The ") + view.what + " frame of " + name,
                        "class=\"after\" " + data + (views == 0 ? "" : " hidden")) +
              "\n";
    buttons += std::string("<button type=\"button\" ") + data + " aria-pressed=\"" + chosen + "\">" +
               view.label + "</button>";
    ++views;
  }
  if (views == 1) buttons.clear();  // nothing to choose
  return "<div class=\"views\" role=\"group\" aria-label=\"On the right of the line\">" + buttons +
         "</div>\n<div class=\"slider\">\n" +
         ImageHtml(shown.folder / kInputPicture, "The turbulent frame of " + name, "class=\"before\"") +
         "\n" + images +
         "<span class=\"divider\" aria-hidden=\"true\"></span>\n"
         "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"" +
         EscapeHtml("Line between the turbulent frame on its left and the other on its right, " + name) +
         "\">\n</div>\n<p class=\"sides\"><span>turbulent</span><span data-side>restored</span></p>\n";
}

std::string RowsHtml(const ShownClip& shown) {
  std::string html;
  for (const View& row : kRows)
    if (IsThere(shown.folder / row.file))
      html +=
          "<figure>" +
          ImageHtml(shown.folder / row.file,
                    std::string("The middle row of ") + shown.clip->facts.name + " over time, " + row.what,
                    "class=\"over-time\"") +
          "<figcaption>" + row.label + "</figcaption></figure>\n";
  return html.empty() ? ""
                      : "<p class=\"figures\">The middle row over time, downwards: what stands still is "
                        "straight.</p>\n<div class=\"rows\">\n" +
                            html + "</div>\n";
}

std::string FigureRow(const std::string& name, const std::string& value) {
  return "<div><dt>" + EscapeHtml(name) + "</dt><dd>" + EscapeHtml(value) + "</dd></div>\n";
}

// What the input has and what the result has.
std::string BeforeAfter(const ClipResult& clip, Measure measure) {
  const ResultRow *input = FindRow(clip, kInputName), *full = FindRow(clip, kFullName);
  const Value before = input ? input->measures[measure] : Value(),
              after = full ? full->measures[measure] : Value();
  if (!before && !after) return "";
  const MeasureText& text = TextOf(measure);
  return FigureRow(text.label, Shown(before, text.decimals) + " to " + ShownWithUnit(after, text));
}

std::string FiguresHtml(const ClipResult& clip) {
  const ClipFacts& facts = clip.facts;
  std::string rows;
  for (const Measure measure : {Measure::kPsnr, Measure::kPsnrBackground, Measure::kPsnrForeground,
                                Measure::kSsim, Measure::kLineDeviation, Measure::kStability})
    rows += BeforeAfter(clip, measure);
  for (const Measure measure : {Measure::kIou, Measure::kShiftP95})
    if (const Value found = Found(clip, measure))
      rows += FigureRow(TextOf(measure).label, ShownWithUnit(found, TextOf(measure)));
  if (facts.tilt_rms_px)
    rows += FigureRow("true tilt", Shown(facts.tilt_rms_px, 2) + " px, " + StrengthOf(facts));
  if (facts.shakes) rows += FigureRow("camera", *facts.shakes ? "shakes" : "still");
  if (facts.objects) rows += FigureRow("moving", cli::Counted(*facts.objects, "object"));
  return "<dl class=\"summary\">\n" + rows + "</dl>\n";
}

}  // namespace

std::vector<ShownClip> ClipsToShow(const std::vector<const ClipResult*>& clips,
                                   const std::filesystem::path& report, const std::string& ids) {
  std::vector<ShownClip> shown;
  for (const ClipResult* clip : clips) {
    const std::filesystem::path folder = PicturesOf(report, clip->facts.name);
    if (shown.size() == kClipsShown) break;
    if (IsThere(folder / kInputPicture) && IsThere(folder / kResultPicture))
      shown.push_back({clip, ids + std::to_string(shown.size() + 1), folder});
  }
  return shown;
}

std::string ShownClipsHtml(const std::vector<ShownClip>& shown) {
  std::string html;
  for (const ShownClip& one : shown) {
    const Value gain = FullGain(*one.clip);
    html += "<article class=\"clip\" id=\"" + one.id + "\">\n<h3>" + EscapeHtml(one.clip->facts.name) +
            (gain ? " <small>" + EscapeHtml(ShownWithUnit(gain, TextOf(Measure::kPsnr), Sign::kAlways)) +
                        "</small>"
                  : "") +
            "</h3>\n<div class=\"seen\">\n<div class=\"compared\"" + WidthOf(one.clip->facts.size) + ">\n" +
            SliderHtml(one) + "</div>\n" + FiguresHtml(*one.clip) + "</div>\n" + RowsHtml(one) +
            "</article>\n";
  }
  return html;
}

}  // namespace shimmer::restore::app
