// Objects drawn from nothing: a car of boxes, a disc, a walking figure. Each is made of parts whose distance
// from any place is known exactly, so that it may lie at any place, turned and scaled, and its coverage of
// each pixel is right.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/layer.h"
#include "sim/motion.h"

namespace shimmer::sim {

enum class Shape { kBox, kDisc, kWalker };
inline constexpr std::array<const char*, 3> kShapeNames = {"box", "disc", "walker"};  // in the order of Shape

// Of one colour. In units of the object's height, x to the right, y down, (0, 0) the object's middle.
struct ShapePart {
  // A capsule: all within `radius` of the line from a to b. A box: around a, b its half width and height, its
  // corners rounded by `radius`.
  enum class Kind { kCapsule, kBox } kind;
  cv::Point2d a, b;
  double radius;
  cv::Vec3f colour;      // [0, 1]
  bool painted = false;  // on what the parts before it cover; covers nothing itself

  double DistanceTo(cv::Point2d place) const;  // negative within
};

// From the farthest part to the nearest. stride: how far a walker has come, in strides (two steps); a disc
// turns by its pose. colour: of most of it; the rest follows from it.
std::vector<ShapePart> PartsOf(Shape shape, double stride, const cv::Vec3f& colour);

// The same, heading to the left.
std::vector<ShapePart> Mirrored(std::vector<ShapePart> parts);

// The parts at a pose; an object's height is height_px times the pose's scale. The area is the least that
// holds all of it that lies within another; empty if there is nothing, as for a height of 0. Coverage of a
// pixel: by the distance of its middle from the edge, 0.5 - d within [0, 1], which is exact where a straight
// edge crosses it upright.
Layer DrawParts(const std::vector<ShapePart>& parts, double height_px, const Pose& pose,
                cv::Rect within = kEverywhere);

// Of each pixel of an area, in px: the way of what is seen there to where it is in `next`, the same shape's
// parts at another time. CV_32FC2; NaN where less than half of the pixel is covered. Parts are rigid: each
// moves with its line.
cv::Mat PartsFlow(const std::vector<ShapePart>& now, const Pose& pose, const std::vector<ShapePart>& next,
                  const Pose& next_pose, double height_px, cv::Rect area);

}  // namespace shimmer::sim
