// The page behind contact sheets: columns under titles and legends, rows of cells under labels, set with even
// margins.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace shimmer::app {

class Page {
 public:
  struct Column {
    std::string title;
    cv::Mat legend;  // CV_8UC3 or empty; shown at the right of the title
  };
  enum class Labels { kWrapped, kOneLine };  // what a label does that is wider than the page

  Page(std::vector<Column> columns, int cell_px) : columns_(std::move(columns)), cell_px_(cell_px) {}

  // images: CV_8UC3, one a column; an empty one is shown as absent. Keeps them at the size that they are
  // shown in.
  void AddRow(const std::string& label, const std::vector<cv::Mat>& images);

  cv::Mat Draw(Labels labels = Labels::kWrapped) const;  // CV_8UC3 RGB

 private:
  struct Row {
    std::string label;
    std::vector<cv::Mat> cells;
    cv::Size absent_size;  // of the boxes that stand for missing images: as its images are

    cv::Size CellSize(size_t i) const { return cells[i].empty() ? absent_size : cells[i].size(); }
    int Height() const;
  };
  std::vector<int> ColumnWidths() const;

  std::vector<Column> columns_;
  int cell_px_;
  std::vector<Row> rows_;
};

// An image at the size that a page shows it in: down to cell_px by areas, or up by a whole factor as far as
// it fits, so that pixels stay squares. One that has it already is not changed.
cv::Mat Fitted(const cv::Mat& image, int cell_px);

cv::Mat TiltLegend(double full_scale_px);            // wheel of TiltAsColours, with what its rim means
cv::Mat SigmaLegend(double low_px, double high_px);  // bar of SigmaAsHeat, with what its ends mean

}  // namespace shimmer::app
