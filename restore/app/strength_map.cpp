#include "restore/app/strength_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>

#include "restore/app/optics_options.h"
#include "sim/dataset/image_io.h"

namespace shimmer::restore::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMapSide_px = 480, kLeastCell_px = 2;  // as it is shown: the longer side, about
constexpr int kGap_px = 16, kBarWidth_px = 20, kTextWidth_px = 130, kLeastHeight_px = 120;
constexpr double kTextScale = 0.4;
constexpr uchar kUnknownGrey = 128;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }

// Rows of the map, each number times `factor`.
Json Rows(const cv::Mat& map, double factor) {
  Json rows = Json::array();
  for (int y = 0; y < map.rows; ++y) {
    Json row = Json::array();
    for (int x = 0; x < map.cols; ++x) row.push_back(NumberOrNull(factor * map.at<float>(y, x)));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json OpticsJson(const Optics& optics) {
  return {{"pixel_rad", optics.pixel_rad},
          {"aperture_m", optics.aperture_m},
          {"distance_m", optics.distance_m},
          {"tilt", TiltName(optics.tilt)},
          {"tilt_constant", TiltConstant(optics.tilt)},
          {"source", optics.point_source ? "point" : "parallel"}};
}

// What Cn2 is where the tilt's variance is 1 px^2.
double Cn2PerPx2(const Optics& optics) { return Cn2Of(1, optics); }

// What all but a fiftieth of the squares are below: the lightest colour. A few, cut by the frame's edge, lie
// far beyond.
double TopOf(const cv::Mat& map) {
  std::vector<double> values;
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x)
      if (const double value = map.at<float>(y, x); std::isfinite(value)) values.push_back(value);
  if (values.empty()) return 0;
  const auto top = values.begin() + (std::ssize(values) - 1) * 98 / 100;
  std::ranges::nth_element(values, top);
  return *top;
}

cv::Mat AsColours(const cv::Mat& levels) {
  cv::Mat colours;
  cv::applyColorMap(levels, colours, cv::COLORMAP_INFERNO);
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGB);
  return colours;
}

// From the top to none.
void DrawBar(cv::Mat& picture, cv::Rect bar, const std::string& top, const std::string& unit) {
  cv::Mat levels(bar.size(), CV_8UC1);
  for (int y = 0; y < bar.height; ++y) levels.row(y).setTo(255 - 255 * y / std::max(1, bar.height - 1));
  AsColours(levels).copyTo(picture(bar));
  const auto write = [&](const std::string& text, int y) {
    cv::putText(picture, text, {bar.br().x + 6, y}, cv::FONT_HERSHEY_SIMPLEX, kTextScale, cv::Scalar::all(20),
                1, cv::LINE_AA);
  };
  write(top, bar.y + 10);
  write(unit, bar.y + 26);
  write("0", bar.br().y - 2);
  write("grey: no texture", bar.br().y + 18);
}

}  // namespace

Json StrengthJson(const TurbulenceStrength& strength, const std::optional<Optics>& optics,
                  const RestorePlan& plan) {
  const bool known = strength.texture > 0;
  const double variance = strength.tilt_variance_px2, factor = optics ? Cn2PerPx2(*optics) : 0;
  return {{"tilt_rms_px", known ? Json(std::sqrt(variance)) : Json()},
          {"tilt_variance_px2", known ? Json(variance) : Json()},
          {"cn2", known && optics ? Json(factor * variance) : Json()},
          {"cn2_unit", "m^(-2/3)"},
          {"steadied", plan.stabilise},
          {"optics", optics ? OpticsJson(*optics) : Json()},
          {"texture", strength.texture},
          {"noise_levels", strength.noise_levels},
          {"square_px", strength.square_px},
          {"map_from_px", {plan.picture.x, plan.picture.y}},
          {"map_tilt_variance_px2", Rows(strength.map, 1)},
          {"map_cn2", optics ? Rows(strength.map, factor) : Json()}};
}

std::vector<uint8_t> StrengthExr(const TurbulenceStrength& strength, const std::optional<Optics>& optics) {
  std::vector<std::string> names = {"tilt_variance_px2"};
  cv::Mat map = strength.map;
  if (optics) {
    names.emplace_back("cn2");
    cv::merge(std::vector<cv::Mat>{strength.map, strength.map * Cn2PerPx2(*optics)}, map);
  }
  return dataset::EncodeExrAsIs(map, names);
}

cv::Mat StrengthPicture(const TurbulenceStrength& strength, const std::optional<Optics>& optics) {
  const cv::Mat& map = strength.map;
  const double top = TopOf(map);
  const int cell = std::max(kLeastCell_px, kMapSide_px / std::max(map.cols, map.rows));
  cv::Mat levels(map.size(), CV_8UC1), unknown(map.size(), CV_8UC1), shown;
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.cols; ++x) {
      const double value = map.at<float>(y, x);
      unknown.at<uchar>(y, x) = std::isfinite(value) ? 0 : 255;
      levels.at<uchar>(y, x) =
          std::isfinite(value) && top > 0 ? cv::saturate_cast<uchar>(255 * value / top) : uchar{0};
    }
  cv::Mat colours = AsColours(levels);
  colours.setTo(cv::Scalar::all(kUnknownGrey), unknown);
  cv::resize(colours, shown, map.size() * cell, 0, 0, cv::INTER_NEAREST);
  cv::Mat picture(std::max(shown.rows, kLeastHeight_px) + 2 * kGap_px,
                  shown.cols + 3 * kGap_px + kBarWidth_px + kTextWidth_px, CV_8UC3, cv::Scalar::all(255));
  shown.copyTo(picture({kGap_px, kGap_px, shown.cols, shown.rows}));
  char text[32];
  std::snprintf(text, sizeof text, "%.3g or more", optics ? Cn2PerPx2(*optics) * top : top);
  const cv::Rect bar(shown.cols + 2 * kGap_px, kGap_px, kBarWidth_px, picture.rows - 3 * kGap_px);
  DrawBar(picture, bar, text, optics ? "Cn2, m^(-2/3)" : "tilt variance, px^2");
  return picture;
}

}  // namespace shimmer::restore::app
