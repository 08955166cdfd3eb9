#include "tests/bench/plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

// Everything is drawn twice as large and then halved: OpenCV's letters and dashes get smooth edges.
constexpr int kFine = 2;
constexpr int kPanelWidth = 860, kPanelHeight = 560, kTitleHeight = 70, kLegendLine = 34, kMargin = 24;
const cv::Scalar kInk(50, 45, 40), kPale(228, 226, 224), kPaler(242, 241, 240), kPaper(255, 255, 255);

enum class Align { kLeft, kCentre, kRight };

class Canvas {
 public:
  Canvas(int width, int height) : fine_(height * kFine, width * kFine, CV_8UC3, kPaper) {}

  cv::Mat Halved() const {
    cv::Mat image;
    cv::resize(fine_, image, {}, 1.0 / kFine, 1.0 / kFine, cv::INTER_AREA);
    return image;
  }

  void Line(cv::Point2d a, cv::Point2d b, const cv::Scalar& colour, double width_px) {
    cv::line(fine_, Fine(a), Fine(b), colour, std::max(1, cvRound(width_px * kFine)), cv::LINE_AA);
  }

  void Dashes(cv::Point2d a, cv::Point2d b, const cv::Scalar& colour, double width_px) {
    constexpr double kDashPx = 6, kGapPx = 5;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const cv::Point2d along = length > 0 ? (b - a) / length : cv::Point2d();
    for (double at = 0; at < length; at += kDashPx + kGapPx)
      Line(a + along * at, a + along * std::min(at + kDashPx, length), colour, width_px);
  }

  // size: the height of capitals in px; (x, y) is the middle of that height.
  void Text(const std::string& text, cv::Point2d at, double size, Align align,
            const cv::Scalar& colour = kInk, bool bold = false, const std::optional<cv::Scalar>& halo = {}) {
    if (halo) TextInto(fine_, text, Fine(at), size, align, *halo, 4 * kFine);
    TextInto(fine_, text, Fine(at), size, align, colour, bold ? kFine + 1 : 0.75 * kFine);
  }

  // Upwards, its middle at `at`.
  void UprightText(const std::string& text, cv::Point2d at, double size) {
    const int long_px = 400 * kFine, high_px = 30 * kFine;
    cv::Mat lying(high_px, long_px, CV_8UC3, kPaper), upright;
    TextInto(lying, text, {long_px / 2, high_px / 2}, size, Align::kCentre, kInk, 0.75 * kFine);
    cv::rotate(lying, upright, cv::ROTATE_90_COUNTERCLOCKWISE);
    const cv::Point corner = Fine(at) - cv::Point(high_px / 2, long_px / 2);
    upright.copyTo(fine_(cv::Rect(corner, upright.size())));
  }

  void Mark(cv::Point2d at, const Look& look, bool ringed) {
    constexpr double kRadius = 4.5;
    if (ringed) cv::circle(fine_, Fine(at), cvRound(10 * kFine), look.colour, 2 * kFine, cv::LINE_AA);
    std::vector<cv::Point> outline;
    if (look.marker == Marker::kSquare)
      for (const auto& [dx, dy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        outline.push_back(Fine(at + cv::Point2d(dx, dy) * kRadius));
    if (look.marker == Marker::kTriangle)
      for (const auto& [dx, dy] : {std::pair{0.0, -1.35}, {1.2, 0.9}, {-1.2, 0.9}})
        outline.push_back(Fine(at + cv::Point2d(dx, dy) * kRadius));
    if (look.marker == Marker::kCircle)
      cv::ellipse2Poly(Fine(at), cv::Size(1, 1) * cvRound(kRadius * kFine), 0, 0, 360, 10, outline);
    if (outline.empty()) return;
    cv::fillPoly(fine_, std::vector{outline}, look.filled ? look.colour : kPaper, cv::LINE_AA);
    cv::polylines(fine_, outline, true, look.colour, 2 * kFine - 1, cv::LINE_AA);
  }

 private:
  static cv::Point Fine(cv::Point2d at) { return {cvRound(at.x * kFine), cvRound(at.y * kFine)}; }

  static void TextInto(cv::Mat& image, const std::string& text, cv::Point at, double size, Align align,
                       const cv::Scalar& colour, double stroke) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    constexpr double kCapitals = 21;  // px of the font at scale 1
    const double scale = size * kFine / kCapitals;
    const int thickness = std::max(1, cvRound(stroke));
    int baseline = 0;
    const cv::Size box = cv::getTextSize(text, kFont, scale, thickness, &baseline);
    const int shift = align == Align::kLeft ? 0 : align == Align::kCentre ? box.width / 2 : box.width;
    const cv::Point origin(at.x - shift, at.y + cvRound(size * kFine / 2));
    cv::putText(image, text, origin, kFont, scale, colour, thickness, cv::LINE_AA);
  }

  cv::Mat fine_;
};

// A logarithmic axis. Its ends and its labels are whole decades, or, where it spans few, 1, 2 and 5 of each.
class Axis {
 public:
  Axis(const std::vector<double>& values, double first_px, double last_px)
      : first_px_(first_px), last_px_(last_px) {
    const auto [least, most] = std::ranges::minmax(values);
    fine_ = most / least < 1e3;
    low_ = high_ = StepBelow(least);
    while (high_ == low_ || high_ < most * 0.999) high_ = StepAbove(high_);
  }

  double Px(double value) const {
    const double share = std::log(value / low_) / std::log(high_ / low_);
    return first_px_ + (last_px_ - first_px_) * share;
  }

  // Each whole digit of each decade, and whether it has a label.
  void ForEachTick(const std::function<void(double value, bool labelled)>& tick) const {
    for (int power = static_cast<int>(std::floor(std::log10(low_) + 1e-9));
         std::pow(10, power) <= high_ * 1.001; ++power)
      for (int digit = 1; digit < 10; ++digit) {
        const double value = digit * std::pow(10, power);
        if (value < low_ * 0.999 || value > high_ * 1.001) continue;
        tick(value, digit == 1 || (fine_ && (digit == 2 || digit == 5)));
      }
  }

 private:
  double StepBelow(double value) const {
    const double decade = std::pow(10, std::floor(std::log10(value) + 1e-9));
    for (const double digit : {5, 2})
      if (fine_ && value >= digit * decade) return digit * decade;
    return decade;
  }
  double StepAbove(double value) const {
    const double decade = StepBelow(value);
    const double digit = decade / std::pow(10, std::floor(std::log10(decade) + 1e-9));
    if (!fine_) return 10 * decade;
    return decade * (digit > 1.5 && digit < 3 ? 2.5 : 2);
  }

  double first_px_, last_px_, low_ = 1, high_ = 1;
  bool fine_ = false;  // labels within decades
};

std::string TickText(double value) {
  if (value > 0.0009) return Significant(value, 6);
  const int power = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  return Significant(value / std::pow(10, power), 1) + "e" + std::to_string(power);
}

void DrawPanel(Canvas& canvas, cv::Point2d corner, const Panel& panel) {
  const double left = corner.x + 92, right = corner.x + kPanelWidth - 24, top = corner.y + 44,
               bottom = corner.y + kPanelHeight - 66;
  std::vector<double> xs, ys;
  const auto x_of = [&](const PlotPoint& point) { return std::max(point.x, panel.least_x); };
  for (const Series& series : panel.series)
    for (const PlotPoint& point : series.points) xs.push_back(x_of(point)), ys.push_back(point.y);
  const Axis across(xs, left, right), up(ys, bottom, top);

  across.ForEachTick([&](double value, bool labelled) {
    const double px = across.Px(value);
    canvas.Line({px, top}, {px, bottom}, labelled ? kPale : kPaler, 1);
    if (labelled) canvas.Text(TickText(value), {px, bottom + 18}, 10, Align::kCentre);
  });
  up.ForEachTick([&](double value, bool labelled) {
    const double px = up.Px(value);
    canvas.Line({left, px}, {right, px}, labelled ? kPale : kPaler, 1);
    if (labelled) canvas.Text(TickText(value), {left - 10, px}, 10, Align::kRight);
  });
  canvas.Line({left, bottom}, {right, bottom}, kInk, 1);
  canvas.Line({left, top}, {left, bottom}, kInk, 1);
  canvas.Text(panel.title, {left, corner.y + 22}, 13, Align::kLeft, kInk, true);
  canvas.Text(panel.x_label, {(left + right) / 2, bottom + 44}, 11, Align::kCentre);
  canvas.UprightText(panel.y_label, {corner.x + 20, (top + bottom) / 2}, 11);

  const auto place = [&](const PlotPoint& point) {
    return cv::Point2d(across.Px(x_of(point)), up.Px(point.y));
  };
  for (const Series& series : panel.series)
    for (size_t i = 1; series.look.line && i < series.points.size(); ++i) {
      const cv::Point2d from = place(series.points[i - 1]), to = place(series.points[i]);
      if (series.look.dashed)
        canvas.Dashes(from, to, series.look.colour, 1.5);
      else
        canvas.Line(from, to, series.look.colour, 2);
    }
  for (const Series& series : panel.series)
    for (const PlotPoint& point : series.points) canvas.Mark(place(point), series.look, point.ringed);

  // Names below their points, where curves that fall leave room; those of ringed points first; what would lie
  // over another is left out.
  std::vector<cv::Point2d> named;
  for (const bool ringed : {true, false})
    for (const Series& series : panel.series)
      for (const PlotPoint& point : series.points) {
        cv::Point2d at = place(point) + cv::Point2d(-4, 19);
        at.x = std::max(at.x, left + 18);  // clear of the axis
        const bool free = std::ranges::none_of(named, [&](const cv::Point2d& other) {
          return std::abs(at.x - other.x) < 40 && std::abs(at.y - other.y) < 14;
        });
        if (point.name.empty() || point.ringed != ringed || !free) continue;
        canvas.Text(point.name, at, 9.5, Align::kCentre, series.look.colour, false, kPaper);
        named.push_back(at);
      }
}

}  // namespace

cv::Mat DrawPlot(const std::string& title, const std::vector<Panel>& panels,
                 const std::vector<LegendEntry>& legend) {
  constexpr int kInARow = 2;
  const int rows = (static_cast<int>(panels.size()) + kInARow - 1) / kInARow;
  const int legend_rows = (static_cast<int>(legend.size()) + kInARow) / (kInARow + 1);
  const int width = kInARow * kPanelWidth + 2 * kMargin;
  Canvas canvas(width, kTitleHeight + rows * kPanelHeight + legend_rows * kLegendLine + 2 * kMargin);
  canvas.Text(title, {width / 2.0, kMargin + 14}, 17, Align::kCentre, kInk, true);
  for (int i = 0; i < static_cast<int>(panels.size()); ++i)
    DrawPanel(canvas,
              cv::Point2d(kMargin + i % kInARow * kPanelWidth, kTitleHeight + i / kInARow * kPanelHeight),
              panels[i]);
  // Column by column, so that what belongs together stands together.
  for (int i = 0; i < static_cast<int>(legend.size()); ++i) {
    const cv::Point2d at(kMargin + 92 + (i / legend_rows) * (width / (kInARow + 1.0)),
                         kTitleHeight + rows * kPanelHeight + kMargin + (i % legend_rows) * kLegendLine);
    const Look& look = legend[i].look;
    if (look.line && look.dashed)
      canvas.Dashes(at - cv::Point2d(22, 0), at + cv::Point2d(22, 0), look.colour, 1.5);
    if (look.line && !look.dashed)
      canvas.Line(at - cv::Point2d(22, 0), at + cv::Point2d(22, 0), look.colour, 2);
    canvas.Mark(at, look, legend[i].ringed);
    canvas.Text(legend[i].text, at + cv::Point2d(36, 0), 11, Align::kLeft);
  }
  return canvas.Halved();
}

}  // namespace shimmer::bench
