// Small plots with logarithmic axes: points, lines, a legend. Drawn by OpenCV, no other tool.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace shimmer::bench {

enum class Marker { kCircle, kSquare, kTriangle, kNone };

struct Look {
  cv::Scalar colour;  // B, G, R of 255
  Marker marker = Marker::kCircle;
  bool filled = true;
  bool line = true;     // joins the points in their order
  bool dashed = false;  // that line
};

struct PlotPoint {
  double x, y;       // above 0; smaller ones are drawn at the axis' end
  std::string name;  // beside the point; "": none
  bool ringed = false;
};

struct Series {
  Look look;
  std::vector<PlotPoint> points;
};

struct Panel {
  std::string title, x_label, y_label;
  double least_x;  // what is below lies on the axis
  std::vector<Series> series;
};

struct LegendEntry {
  std::string text;
  Look look;
  bool ringed = false;
};

// Panels two in a row under a title, the legend below: CV_8UC3, BGR.
cv::Mat DrawPlot(const std::string& title, const std::vector<Panel>& panels,
                 const std::vector<LegendEntry>& legend);

}  // namespace shimmer::bench
