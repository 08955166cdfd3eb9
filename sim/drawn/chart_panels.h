// The panels of the resolution chart: each fills a square of it with one kind of pattern.
#pragma once

#include "sim/drawn/canvas.h"

namespace shimmer::sim {

struct ChartLook {
  Rgb paper, ink, accent;
  double hue_turns;    // of the first colour patch
  double scale;        // of features
  double slant_turns;  // of slanted edges
};

using ChartPanel = void (*)(Canvas&, const cv::Rect2d& area, const ChartLook&);

void BarGroups(Canvas& canvas, const cv::Rect2d& area,
               const ChartLook& look);  // triples, as on the USAF 1951 target
void Checkers(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);     // fields of four cell sizes
void SlantedEdge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);  // as of ISO 12233
void GreySteps(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);
void ColourPatches(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);
void UprightWedge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);  // lines that converge
void LevelWedge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);
void Dots(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);  // points of light of several sizes
void Rings(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);    // concentric circles
void Sweep(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);    // sine of rising frequency
void Letters(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);  // lines of falling size
void Wheel(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look);    // a small star of quarters
void ZonePlate(Canvas& canvas, const cv::Rect2d& area,
               const ChartLook& look);  // the centre piece, with a crosshair

}  // namespace shimmer::sim
