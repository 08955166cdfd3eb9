#include "restore/app/evaluation/report_charts.h"

#include <algorithm>
#include <cmath>

#include "cli/html.h"
#include "cli/number_text.h"
#include "cli/page.h"
#include "cli/svg.h"
#include "cli/ticks.h"
#include "restore/app/evaluation/report_numbers.h"

namespace shimmer::restore::app {
namespace {

using cli::EscapeHtml;
using cli::Line;
using cli::Px;
using cli::Text;

// px of the drawing's own coordinates.
constexpr double kWidth = 440, kHeight = 300, kLeft = 52, kRight = 16, kTop = 30, kBottom = 50;
constexpr double kBase = kHeight - kBottom;
constexpr size_t kMostLines = 8;  // as many colours as the page has

struct Point {
  double x, y;
  std::string title;
};

// A variant's means.
struct Curve {
  std::string name;
  std::vector<Point> points;
};

bool IsFinite(const Value& value) { return value && std::isfinite(*value); }

std::string PointTitle(const std::string& name, double tilt_px, double gain_db) {
  return name + ": tilt " + Shown(tilt_px, 2) + " px, gain " +
         ShownWithUnit(gain_db, TextOf(Measure::kPsnr), Sign::kAlways);
}

std::vector<Point> ClipPoints(const std::vector<ClipResult>& clips) {
  std::vector<Point> points;
  for (const ClipResult& clip : clips) {
    const Value tilt = clip.facts.tilt_rms_px, gain = FullGain(clip);
    if (IsFinite(tilt) && IsFinite(gain))
      points.push_back({*tilt, *gain, PointTitle(clip.facts.name, *tilt, *gain)});
  }
  return points;
}

std::vector<Curve> CurvesOf(const Evaluation& evaluation) {
  std::vector<Curve> curves;
  for (const VariantText& variant : evaluation.variants) {
    if (variant.kind == VariantKind::kInput || curves.size() == kMostLines) continue;
    Curve curve{variant.name, {}};
    for (const ClipGroup& group : GroupsOf(evaluation.clips)) {
      if (group.key != "strength") continue;
      std::vector<Value> tilts;
      for (const ClipResult* clip : group.clips) tilts.push_back(clip->facts.tilt_rms_px);
      const Value tilt = MeanAlone(MeanOf(tilts)),
                  gain = MeanAlone(MeanIn(group, variant.name, kResultStage, Measure::kPsnr, true));
      if (IsFinite(tilt) && IsFinite(gain))
        curve.points.push_back(
            {*tilt, *gain, PointTitle(variant.name + ", " + group.value + ", mean", *tilt, *gain)});
    }
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

// Numbers along an axis, with some room at both ends.
struct Range {
  double low, high;

  explicit Range(double first) : low(first), high(first) {}
  void Take(double value) { low = std::min(low, value), high = std::max(high, value); }
  void Widen() {
    const double room = std::max(0.05 * (high - low), 0.05);  // less than that is rounding
    low -= room, high += room;
  }
  double PartOf(double value) const { return (value - low) / (high - low); }
};

struct Plane {
  Range tilt{0}, gain{0};

  double X(double value) const { return kLeft + (kWidth - kLeft - kRight) * tilt.PartOf(value); }
  double Y(double value) const { return kBase - (kBase - kTop) * gain.PartOf(value); }
};

Plane PlaneOf(const std::vector<Point>& points, const std::vector<Curve>& curves) {
  Plane plane;
  const auto take = [&](const Point& point) { plane.tilt.Take(point.x), plane.gain.Take(point.y); };
  std::ranges::for_each(points, take);
  for (const Curve& curve : curves) std::ranges::for_each(curve.points, take);
  plane.tilt.Widen();
  plane.tilt.low = 0;
  plane.gain.Widen();
  return plane;
}

std::string AxesSvg(const Plane& plane) {
  std::string svg;
  const auto ticks = [](const Range& range) {
    return cli::Ticks(range.low, range.high, 6, cli::AxisKind::kLinear);
  };
  const std::vector<double> across = ticks(plane.tilt), up = ticks(plane.gain);
  for (const double tick : up) {
    svg += Line(kLeft, plane.Y(tick), kWidth - kRight, plane.Y(tick), "grid");
    svg += Text(kLeft - 8, plane.Y(tick) + 4, "end", cli::RoundedText(tick, up[1] - up[0]));
  }
  svg += Line(kLeft, plane.Y(0), kWidth - kRight, plane.Y(0), "axis");  // as good as the input
  svg += Line(kLeft, kBase, kWidth - kRight, kBase, "axis");
  for (const double tick : across) {
    svg += Line(plane.X(tick), kBase, plane.X(tick), kBase + 4, "axis");
    svg += Text(plane.X(tick), kBase + 20, "middle", cli::RoundedText(tick, across[1] - across[0]));
  }
  return svg + Text(4, kTop - 14, "start", "PSNR gain, dB") +
         Text((kLeft + kWidth - kRight) / 2, kHeight - 8, "middle", "true tilt RMS, px") + "\n";
}

std::string DotSvg(const Point& point, const Plane& plane, const std::string& kind, double radius) {
  return "<circle class=\"" + kind + "\" cx=\"" + Px(plane.X(point.x)) + "\" cy=\"" + Px(plane.Y(point.y)) +
         "\" r=\"" + Px(radius) + "\"><title>" + EscapeHtml(point.title) + "</title></circle>\n";
}

std::string CurveSvg(const Curve& curve, const Plane& plane, const std::string& kind) {
  std::string path, dots;
  for (const Point& point : curve.points) {
    path += (path.empty() ? "" : " ") + Px(plane.X(point.x)) + "," + Px(plane.Y(point.y));
    dots += DotSvg(point, plane, "mean " + kind, 4);
  }
  return "<polyline class=\"curve " + kind + "\" points=\"" + path + "\"/>\n" + dots;
}

std::string KindOf(size_t curve) { return "v" + std::to_string(curve); }

std::string LegendHtml(const std::vector<Curve>& curves) {
  std::string html = "<ul class=\"legend\">\n";
  for (size_t i = 0; i < curves.size(); ++i)
    html += "<li><svg width=\"30\" height=\"10\" aria-hidden=\"true\">" +
            Line(1, 5, 29, 5, "curve " + KindOf(i)) + "</svg>" + EscapeHtml(curves[i].name) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

std::string StageTimesHtml(const ClipGroup& all) {
  struct StageTime {
    std::string stage;
    double ms;
  };
  std::vector<StageTime> times;
  double sum = 0, most = 0;
  for (const char* stage : kStageNames) {
    const Value ms = MeanAlone(MeanIn(all, kFullName, stage, Measure::kTime, false));
    if (!IsFinite(ms)) continue;
    times.push_back({stage, *ms});
    sum += *ms, most = std::max(most, *ms);
  }
  if (times.empty()) return "";
  std::string bars = "<ol class=\"bars\">\n";
  for (const auto& [stage, ms] : times) {
    const std::string text = ShownWithUnit(ms, TextOf(Measure::kTime));
    bars += cli::Bar({stage, text, sum > 0 ? Px(100 * ms / sum) + " %" : "", stage + ": " + text},
                     "data-stage=\"" + EscapeHtml(stage) + "\" data-value=\"" + Exact(ms) + "\"",
                     most > 0 ? 100 * ms / most : 0);
  }
  return "<div class=\"charts\">\n" +
         cli::Chart("Time in each stage",
                    {"Means over clips, " + ShownWithUnit(sum, TextOf(Measure::kTime)) + " in all."},
                    bars + "</ol>\n") +
         "</div>\n";
}

std::string QualityChartHtml(const Evaluation& evaluation) {
  const std::vector<Point> points = ClipPoints(evaluation.clips);
  const std::vector<Curve> curves = CurvesOf(evaluation);
  const std::string title = "Quality against strength";
  if (points.empty() && curves.empty())
    return cli::Chart(title, {}, "<p class=\"none\">No clip has both a known tilt and a gain.</p>\n");
  const Plane plane = PlaneOf(points, curves);
  std::string svg = "<svg class=\"quality\" viewBox=\"0 0 " + Px(kWidth) + " " + Px(kHeight) +
                    "\" role=\"img\" aria-label=\"" +
                    EscapeHtml("PSNR gain over the input against the true tilt, of " +
                               cli::Counted(std::ssize(points), "clip") + " and " +
                               cli::Counted(std::ssize(curves), "variant")) +
                    "\">\n" + AxesSvg(plane);
  for (const Point& point : points) svg += DotSvg(point, plane, "clip", 3);
  // The first, which is the pipeline as it was asked for, on top.
  for (size_t i = curves.size(); i-- > 0;) svg += CurveSvg(curves[i], plane, KindOf(i));
  return cli::Chart(
      title,
      {curves.size() == kMostLines ? "Of the first " + cli::Counted(kMostLines, "variant") + "." : "",
       "Dots are clips, restored by the full pipeline; lines are variants' means over the "
       "weak, the medium and the strong clips. Above 0 is better than the input."},
      svg + "</svg>\n" + LegendHtml(curves));
}

}  // namespace shimmer::restore::app
