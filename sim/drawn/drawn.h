// Scenes drawn from nothing: clean frames that need no data, made to show what turbulence does and what a
// restoration gives back. Every scene is a function of the pixel's place, so it goes on beyond the crop, and
// the same bytes come out for the same arguments on any machine.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string_view>
#include <vector>

namespace shimmer::sim {

enum class DrawnScene { kChart, kBricks, kText, kStar, kStripes };

// In the order of DrawnScene.
inline constexpr std::array<const char*, 5> kDrawnSceneNames = {"chart", "bricks", "text", "star", "stripes"};

DrawnScene DrawnSceneNamed(std::string_view name);  // throws std::invalid_argument for any other name

// The crop, size, with halo_px more on every side: CV_32FC3 RGB in [0, 1], the crop's first pixel at
// (halo_px, halo_px). The crop's pixels are the same whatever the halo. scale in [0.001, 1000] multiplies the
// size of features, as far as they still fit the crop and the pixel grid (nothing finer than the grid can
// carry is drawn: it fades to its mean). variation, any number, changes details: colours, phases, the order
// of sentences. Throws std::invalid_argument for an empty size, halo_px < 0, or a scale out of its range.
cv::Mat DrawScene(DrawnScene scene, cv::Size size, int halo_px, double scale, uint64_t variation);

// What the stripes are, so that a measurement has its truth. Panels fill the crop, gaps between them aside;
// those at the crop's edge go on into the halo.
struct StripePanel {
  cv::Rect area;          // px of the crop
  double period_px;       // along direction
  cv::Point2d direction;  // unit vector across the stripes
  bool square;            // square wave; else a sine
};
std::vector<StripePanel> StripePanels(cv::Size size, double scale);

// The star: dark and light spokes around the crop's centre, full contrast within the radius as far as a spoke
// and its gap are 4 px wide together, grey where they are 2 px or less; outside the radius they go on paler.
inline constexpr int kStarSpokes = 36;
double StarRadius(cv::Size size, double scale);  // px

}  // namespace shimmer::sim
