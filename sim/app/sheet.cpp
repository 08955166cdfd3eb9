#include "sim/app/sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cli/ticks.h"
#include "sim/app/colour_maps.h"
#include "sim/app/sheet_page.h"

namespace shimmer::app {
namespace {

constexpr int kClipCellPx = 512;

// A frame as it is shown: RGB, 8 bits.
cv::Mat Shown(const cv::Mat& frame) {
  if (frame.empty()) return {};
  if (frame.type() != CV_32FC1 && frame.type() != CV_32FC3)
    throw std::invalid_argument("frame to show must be CV_32FC1 or CV_32FC3");
  cv::Mat shown(frame.size(), CV_8UC3);
  const int channels = frame.channels();
  for (int y = 0; y < frame.rows; ++y) {
    const float* values = frame.ptr<float>(y);
    for (int x = 0; x < frame.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = values[x * channels + (channels == 3 ? c : 0)];
        // convertTo would make black of +Inf
        shown.at<cv::Vec3b>(y, x)[c] = value > 0 ? cv::saturate_cast<uchar>(255 * std::min(value, 1.f)) : 0;
      }
    }
  }
  return shown;
}

// A frame as a page shows it, with marks where there are any.
cv::Mat Marked(const cv::Mat& frame, int cell_px, const std::optional<SceneMarks>& marks,
               void (*mark)(cv::Mat&, const SceneMarks&)) {
  cv::Mat shown = Shown(frame);
  if (shown.empty() || !marks) return shown;
  shown = Fitted(shown, cell_px);  // first: lines must not shrink with the frame
  mark(shown, *marks);
  return shown;
}

// A round end of a scale that is not below value; 1 for 0.
double ScaleEnd(double value) { return value > 0 ? cli::RoundUp(value, {1, 1.5, 2, 3, 4, 5, 6, 8}) : 1; }

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void Add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// Twice the RMS is passed by one shift in fifty: full colours are in use, and few are cut.
double TiltScale(std::span<const SheetRow> rows) {
  double sum = 0, longest = 0, count = 0;
  for (const SheetRow& row : rows) {
    for (auto shift = row.tilt.begin<cv::Vec2f>(); shift != row.tilt.end<cv::Vec2f>(); ++shift) {
      const double length = std::hypot((*shift)[0], (*shift)[1]);
      if (!std::isfinite(length)) continue;
      sum += length * length;
      longest = std::max(longest, length);
      ++count;
    }
  }
  return ScaleEnd(std::min(longest, 2 * std::sqrt(sum / std::max(count, 1.0))));
}

Range SigmaScale(std::span<const SheetRow> rows) {
  Range sigma;
  for (const SheetRow& row : rows)
    for (auto value = row.sigma.begin<float>(); value != row.sigma.end<float>(); ++value) sigma.Add(*value);
  const double high = ScaleEnd(sigma.high);
  // From 0, unless all of it lies in the scale's upper half.
  return {sigma.low > 0.5 * high ? 0.5 * high : 0, high};
}

void CheckTruth(const SheetRow& row) {
  if (!row.tilt.empty() && row.tilt.type() != CV_32FC2)
    throw std::invalid_argument("tilt to show must be CV_32FC2");
  if (!row.sigma.empty() && row.sigma.type() != CV_32FC1)
    throw std::invalid_argument("sigma to show must be CV_32FC1");
}

}  // namespace

cv::Mat DrawSheet(std::span<const SheetRow> rows, int cell_px) {
  if (cell_px < 16) throw std::invalid_argument("cell_px = " + std::to_string(cell_px) + ", must be >= 16");
  for (const SheetRow& row : rows) CheckTruth(row);
  const double tilt_px = TiltScale(rows);
  const Range sigma_px = SigmaScale(rows);
  const bool any_tilt =
      std::any_of(rows.begin(), rows.end(), [](const SheetRow& row) { return !row.tilt.empty(); });
  const bool any_sigma =
      std::any_of(rows.begin(), rows.end(), [](const SheetRow& row) { return !row.sigma.empty(); });

  Page page({{"clean", {}},
             {"turbulent", {}},
             {"tilt", any_tilt ? TiltLegend(tilt_px) : cv::Mat()},
             {"sigma", any_sigma ? SigmaLegend(sigma_px.low, sigma_px.high) : cv::Mat()}},
            cell_px);
  for (const SheetRow& row : rows) {
    page.AddRow(
        row.label,
        {Marked(row.clean, cell_px, row.marks, MarkClean), Marked(row.turb, cell_px, row.marks, MarkTurb),
         row.tilt.empty() ? cv::Mat() : TiltAsColours(row.tilt, tilt_px),
         row.sigma.empty() ? cv::Mat() : SigmaAsHeat(row.sigma, sigma_px.low, sigma_px.high)});
  }
  return page.Draw();
}

cv::Mat DrawClipFrame(const cv::Mat& clean, const cv::Mat& turb, const std::string& label,
                      const std::optional<SceneMarks>& marks) {
  Page page({{"clean", {}}, {"turbulent", {}}}, kClipCellPx);
  page.AddRow(label,
              {Marked(clean, kClipCellPx, marks, MarkClean), Marked(turb, kClipCellPx, marks, MarkTurb)});
  return page.Draw(Page::Labels::kOneLine);
}

}  // namespace shimmer::app
