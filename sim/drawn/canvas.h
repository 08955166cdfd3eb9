// What drawn scenes are drawn on: a float image of the crop and its halo, addressed in px of the crop. Pixel
// (x, y) is the square of side 1 around (x, y); shapes are blended by the share of it that they cover.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "sim/drawn/letters.h"

namespace shimmer::sim {

using Rgb = cv::Vec3f;  // [0, 1]

inline Rgb Grey(double value) { return Rgb::all(float(value)); }
inline Rgb Mix(const Rgb& a, const Rgb& b, double share_of_b) { return a + (b - a) * float(share_of_b); }
Rgb FromHue(double hue_turns, double saturation, double value);  // hue 0 red, 1/3 green, 2/3 blue

class Canvas {
 public:
  Canvas(cv::Size crop, int halo_px);

  cv::Size crop() const { return crop_; }
  const cv::Mat& pixels() const { return pixels_; }
  cv::Rect2d CropArea() const { return {-0.5, -0.5, double(crop_.width), double(crop_.height)}; }
  cv::Rect2d WholeArea() const;  // with the halo

  // visit(x, y, share, pixel) for each pixel that the area touches; share in (0, 1] of it lies inside.
  template <class Visitor>
  void Visit(const cv::Rect2d& area, Visitor visit) {
    const int x0 = std::max(cvFloor(area.x + 0.5), -halo_px_),
              y0 = std::max(cvFloor(area.y + 0.5), -halo_px_);
    const int x1 = std::min(cvCeil(area.x + area.width - 0.5), crop_.width + halo_px_ - 1);
    const int y1 = std::min(cvCeil(area.y + area.height - 0.5), crop_.height + halo_px_ - 1);
    for (int y = y0; y <= y1; ++y) {
      const double share_y = Overlap(y, area.y, area.y + area.height);
      for (int x = x0; x <= x1; ++x) {
        const double share = share_y * Overlap(x, area.x, area.x + area.width);
        if (share > 0) visit(x, y, share, pixels_.at<Rgb>(y + halo_px_, x + halo_px_));
      }
    }
  }
  // colour(x, y) over an area, blended at its edges by how much of a pixel the area covers.
  template <class Colour>
  void Paint(const cv::Rect2d& area, Colour colour) {
    Visit(area, [&](int x, int y, double share, Rgb& pixel) { pixel = Mix(pixel, colour(x, y), share); });
  }
  // One colour over an area, of which cover(x, y) in [0, 1] is inked.
  template <class Cover>
  void Blend(const cv::Rect2d& area, const Rgb& colour, Cover cover) {
    Visit(area, [&](int x, int y, double share, Rgb& pixel) {
      if (const double ink = share * cover(x, y); ink > 0) pixel = Mix(pixel, colour, ink);
    });
  }

  void Fill(const cv::Rect2d& area, const Rgb& colour);
  void Outline(const cv::Rect2d& area, double width_px, const Rgb& colour);  // inside of the area's edge
  void Disc(cv::Point2d centre, double radius_px, const Rgb& colour);
  void Ring(cv::Point2d centre, double radius_px, double width_px, const Rgb& colour);
  void Polygon(std::span<const cv::Point2d> corners,
               const Rgb& colour);  // convex, corners clockwise on screen
  void Write(const std::string& text, Face face, double capital_px, cv::Point2d baseline, const Rgb& colour);
  void WriteCentred(const std::string& text, Face face, double capital_px, cv::Point2d centre,
                    const Rgb& colour);

 private:
  static double Overlap(int pixel, double low, double high) {
    return std::min(pixel + 0.5, high) - std::max(pixel - 0.5, low);
  }

  cv::Size crop_;
  int halo_px_;
  cv::Mat pixels_;
};

inline cv::Point2d Centre(const cv::Rect2d& area) { return (area.tl() + area.br()) / 2; }

inline double Distance(int x, int y, cv::Point2d to) {
  const double dx = x - to.x, dy = y - to.y;
  return std::sqrt(dx * dx + dy * dy);
}

// Share of a pixel inside an edge that passes `inside_px` from its centre.
inline double EdgeCoverage(double inside_px) { return std::clamp(inside_px + 0.5, 0.0, 1.0); }

}  // namespace shimmer::sim
