#include "sim/app/sheet_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "sim/app/colour_maps.h"
#include "sim/drawn/letters.h"

namespace shimmer::app {
namespace {

using sim::Face;

const cv::Vec3b kPaper(250, 250, 248), kInk(38, 40, 44), kFaint(110, 113, 120), kLine(205, 206, 208),
    kBox(238, 238, 236);

// px
constexpr int kMargin = 28, kGap = 18, kLeastColumn = 190;
constexpr int kLegendHeight = 46, kTitleHeight = 20, kBelowTitles = 9;
constexpr int kLabelLine = 19, kLabelPad = 9, kRowGap = 26;
constexpr double kTitleCapital = 11, kLabelCapital = 8.5, kLegendCapital = 8;

cv::Scalar AsScalar(const cv::Vec3b& colour) { return cv::Scalar(colour[0], colour[1], colour[2]); }

void Write(cv::Mat& page, const std::string& text, Face face, double capital_px, cv::Point2d baseline,
           const cv::Vec3b& ink) {
  sim::Stamp<uchar>(page, sim::DrawLetters(text, face, capital_px, baseline), ink);
}

std::string InPx(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g px", value);
  return text;
}

void DrawCell(cv::Mat& page, const cv::Mat& cell, const cv::Rect& area) {
  cv::rectangle(page, area + cv::Point(-1, -1) + cv::Size(2, 2), AsScalar(kLine), 1);  // around, not over
  if (!cell.empty()) {
    cell.copyTo(page(area));
    return;
  }
  page(area).setTo(AsScalar(kBox));
  const double width_px = sim::TextWidth("absent", Face::kSans, kLabelCapital);
  if (width_px > area.width || kLabelCapital * 2 > area.height) return;
  Write(page, "absent", Face::kSans, kLabelCapital,
        {area.x + (area.width - width_px) / 2, area.y + (area.height + kLabelCapital) / 2}, kFaint);
}

std::vector<std::string> LabelLines(const std::string& label, double width_px, Page::Labels labels) {
  std::vector<std::string> lines = sim::WrapWords(label, Face::kSans, kLabelCapital, width_px);
  if (labels == Page::Labels::kWrapped || lines.size() == 1) return lines;
  if (lines.empty()) return {""};
  const std::string more = " ...";
  const double room_px = width_px - sim::TextWidth(more, Face::kSans, kLabelCapital);
  return {sim::WrapWords(label, Face::kSans, kLabelCapital, room_px)[0] + more};
}

}  // namespace

cv::Mat Fitted(const cv::Mat& image, int cell_px) {
  const int longest = std::max(image.cols, image.rows);
  cv::Mat fitted;
  if (longest > cell_px) {
    const auto side = [&](int px) { return std::max(1, int(std::lround(double(px) * cell_px / longest))); };
    cv::resize(image, fitted, {side(image.cols), side(image.rows)}, 0, 0, cv::INTER_AREA);
  } else {
    cv::resize(image, fitted, image.size() * (cell_px / longest), 0, 0, cv::INTER_NEAREST);
  }
  return fitted;
}

void Page::AddRow(const std::string& label, const std::vector<cv::Mat>& images) {
  Row row{label, {}, {cell_px_, cell_px_ / 2}};
  for (const cv::Mat& image : images)
    row.cells.push_back(image.empty() ? cv::Mat() : Fitted(image, cell_px_));
  for (const cv::Mat& cell : row.cells)
    if (!cell.empty()) row.absent_size = cell.size();
  rows_.push_back(std::move(row));
}

int Page::Row::Height() const {
  int height_px = 0;
  for (size_t i = 0; i < cells.size(); ++i) height_px = std::max(height_px, CellSize(i).height);
  return height_px;
}

std::vector<int> Page::ColumnWidths() const {
  std::vector<int> widths_px(columns_.size(), std::min(cell_px_, kLeastColumn));
  for (size_t i = 0; i < columns_.size(); ++i) {
    const double title_px = sim::TextWidth(columns_[i].title, Face::kSansBold, kTitleCapital);
    widths_px[i] = std::max(widths_px[i], cvCeil(title_px) + kGap + columns_[i].legend.cols);
    for (const Row& row : rows_) widths_px[i] = std::max(widths_px[i], row.CellSize(i).width);
  }
  return widths_px;
}

cv::Mat Page::Draw(Labels labels) const {
  const std::vector<int> widths_px = ColumnWidths();
  int header_px = kTitleHeight;
  for (const Column& column : columns_) header_px = std::max(header_px, column.legend.rows);
  int width_px = 2 * kMargin - kGap;
  for (const int column_px : widths_px) width_px += column_px + kGap;
  const int text_px = width_px - 2 * kMargin;

  int height_px = kMargin + header_px + kBelowTitles + kMargin - kRowGap;
  std::vector<std::vector<std::string>> lines;
  for (const Row& row : rows_) {
    lines.push_back(LabelLines(row.label, text_px, labels));
    height_px += kLabelPad + int(lines.back().size()) * kLabelLine + kLabelPad + row.Height() + kRowGap;
  }

  cv::Mat page(height_px, width_px, CV_8UC3, AsScalar(kPaper));
  int y = kMargin;
  for (size_t i = 0, x = kMargin; i < columns_.size(); x += widths_px[i++] + kGap) {
    Write(page, columns_[i].title, Face::kSansBold, kTitleCapital, {double(x), y + header_px - 3.0}, kInk);
    const cv::Mat& legend = columns_[i].legend;
    if (!legend.empty())
      legend.copyTo(page(cv::Rect({int(x) + widths_px[i] - legend.cols, y}, legend.size())));
  }
  y += header_px + kBelowTitles;
  for (size_t r = 0; r < rows_.size(); ++r) {
    cv::line(page, {kMargin, y}, {width_px - kMargin - 1, y}, AsScalar(kLine), 1);
    y += kLabelPad;
    for (const std::string& line : lines[r]) {
      Write(page, line, Face::kSans, kLabelCapital, {double(kMargin), y + 0.7 * kLabelLine}, kInk);
      y += kLabelLine;
    }
    y += kLabelPad;
    for (size_t i = 0, x = kMargin; i < columns_.size(); x += widths_px[i++] + kGap) {
      DrawCell(page, rows_[r].cells[i], {cv::Point(int(x), y), rows_[r].CellSize(i)});
    }
    y += rows_[r].Height() + kRowGap;
  }
  return page;
}

cv::Mat TiltLegend(double full_scale_px) {
  const std::string text = InPx(full_scale_px) + " or more";
  const int text_px = cvCeil(sim::TextWidth(text, Face::kSans, kLegendCapital)) + 10;
  cv::Mat legend(kLegendHeight, text_px + kLegendHeight, CV_8UC3, AsScalar(kPaper));
  Write(legend, text, Face::kSans, kLegendCapital, {0, kLegendHeight - 3.0}, kFaint);

  // The wheel, drawn large and averaged down for a smooth rim.
  constexpr int kFine = 4, kSide = kLegendHeight * kFine;
  cv::Mat shifts(kSide, kSide, CV_32FC2);
  cv::Mat beyond(kSide, kSide, CV_8UC1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const cv::Vec2f shift((x + 0.5f) / kSide * 2 - 1, (y + 0.5f) / kSide * 2 - 1);
      shifts.at<cv::Vec2f>(y, x) = shift * float(full_scale_px);
      beyond.at<uchar>(y, x) = cv::norm(shift) > 1 ? 255 : 0;
    }
  }
  cv::Mat wheel = TiltAsColours(shifts, full_scale_px);
  wheel.setTo(AsScalar(kPaper), beyond);
  cv::resize(wheel, legend(cv::Rect(text_px, 0, kLegendHeight, kLegendHeight)),
             {kLegendHeight, kLegendHeight}, 0, 0, cv::INTER_AREA);
  return legend;
}

cv::Mat SigmaLegend(double low_px, double high_px) {
  constexpr int kWidth = 112, kBar = 12;
  cv::Mat legend(kLegendHeight, kWidth, CV_8UC3, AsScalar(kPaper)), ramp(kBar, kWidth, CV_32FC1);
  for (int x = 0; x < kWidth; ++x) ramp.col(x).setTo(low_px + (high_px - low_px) * x / (kWidth - 1));
  SigmaAsHeat(ramp, low_px, high_px).copyTo(legend(cv::Rect(0, kLegendHeight - kBar - 20, kWidth, kBar)));
  const std::string high = InPx(high_px);
  Write(legend, InPx(low_px), Face::kSans, kLegendCapital, {0, kLegendHeight - 3.0}, kFaint);
  Write(legend, high, Face::kSans, kLegendCapital,
        {kWidth - 1 - sim::TextWidth(high, Face::kSans, kLegendCapital), kLegendHeight - 3.0}, kFaint);
  return legend;
}

}  // namespace shimmer::app
