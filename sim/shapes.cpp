#include "sim/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/unit_vector.h"

namespace shimmer::sim {
namespace {

using Kind = ShapePart::Kind;

ShapePart Capsule(cv::Point2d a, cv::Point2d b, double radius, const cv::Vec3f& colour) {
  return {Kind::kCapsule, a, b, radius, colour};
}

ShapePart Disc(cv::Point2d centre, double radius, const cv::Vec3f& colour) {
  return Capsule(centre, centre, radius, colour);
}

ShapePart Box(cv::Point2d centre, cv::Point2d half, double rounded, const cv::Vec3f& colour) {
  return {Kind::kBox, centre, half, rounded, colour};
}

ShapePart Painted(ShapePart part) {
  part.painted = true;
  return part;
}

const cv::Vec3f kDark = cv::Vec3f::all(0.08f), kPale = cv::Vec3f::all(0.9f);

cv::Vec3f Darker(const cv::Vec3f& colour) { return colour * 0.5f; }
cv::Vec3f Paler(const cv::Vec3f& colour) { return colour * 0.4f + kPale * 0.6f; }

// Twice as long as it is high, heading to the right.
std::vector<ShapePart> Car(const cv::Vec3f& colour) {
  std::vector<ShapePart> parts = {Box({-0.05, -0.25}, {0.5, 0.25}, 0.12, Darker(colour)),
                                  Box({0, 0.12}, {1, 0.22}, 0.1, colour)};
  for (const double x : {-0.28, 0.18})
    parts.push_back(Painted(Box({x, -0.24}, {0.19, 0.15}, 0.04, Paler(colour))));
  parts.push_back(Painted(Box({0, 0.1}, {0.98, 0.02}, 0.01, Darker(colour))));
  parts.push_back(Painted(Box({0.94, 0.02}, {0.05, 0.05}, 0.02, kPale)));
  for (const double x : {-0.6, 0.6}) {
    parts.push_back(Disc({x, 0.3}, 0.2, kDark));
    parts.push_back(Painted(Disc({x, 0.3}, 0.09, kPale)));
  }
  return parts;
}

// With dots that show how it is turned.
std::vector<ShapePart> Ball(const cv::Vec3f& colour) {
  std::vector<ShapePart> parts = {Disc({0, 0}, 0.5, colour), Painted(Disc({0, 0}, 0.3, Paler(colour)))};
  for (int dot = 0; dot < 5; ++dot)
    parts.push_back(Painted(Disc(UnitVector(dot / 5.0) * 0.4, 0.06, Darker(colour))));
  parts.push_back(Painted(Disc({0.15, 0}, 0.08, kDark)));
  return parts;
}

// A limb of two bones from `joint`: angles from straight down, in turns, forward (to the right) positive.
void AddLimb(std::vector<ShapePart>& parts, cv::Point2d joint, double upper, double lower, double bone,
             double radius, const cv::Vec3f& colour) {
  const auto along = [&](double turns) { return UnitVector(0.25 - turns) * bone; };
  const cv::Point2d middle = joint + along(upper), end = middle + along(lower);
  parts.push_back(Capsule(joint, middle, radius, colour));
  parts.push_back(Capsule(middle, end, radius * 0.85, colour));
}

// Side on, walking to the right: legs swing by 25 degrees, knees bend while a leg comes forward, arms go
// against the legs.
std::vector<ShapePart> Walker(double stride, const cv::Vec3f& colour) {
  constexpr double kSwing = 25.0 / 360, kKnee = 40.0 / 360, kBone = 0.235;
  const cv::Point2d hip(0, 0.01), shoulder(0, -0.27);
  std::vector<ShapePart> parts;
  const auto add_side = [&](double phase, const cv::Vec3f& leg, const cv::Vec3f& arm) {
    const cv::Point2d swing = UnitVector(phase);  // y: the leg's angle; x > 0: it comes forward
    AddLimb(parts, hip, kSwing * swing.y, kSwing * swing.y - kKnee * std::max(0.0, swing.x), kBone, 0.045,
            leg);
    AddLimb(parts, shoulder, -kSwing * swing.y, -kSwing * swing.y + kSwing / 2, 0.15, 0.03, arm);
  };
  add_side(stride + 0.5, Darker(kDark + colour * 0.3f), Darker(colour));  // of the far side
  parts.push_back(Capsule(hip, shoulder, 0.075, colour));
  parts.push_back(Disc({0.01, -0.42}, 0.075, Paler(colour)));
  add_side(stride, kDark + colour * 0.3f, Paler(colour));
  return parts;
}

// What a part takes of the object's own plane.
cv::Rect2d Extent(const ShapePart& part) {
  cv::Point2d low, high;
  if (part.kind == Kind::kBox) {
    low = part.a - part.b, high = part.a + part.b;
  } else {
    const cv::Point2d around(part.radius, part.radius);
    low = cv::Point2d(std::min(part.a.x, part.b.x), std::min(part.a.y, part.b.y)) - around;
    high = cv::Point2d(std::max(part.a.x, part.b.x), std::max(part.a.y, part.b.y)) + around;
  }
  return {low, high};
}

// A part as it moves with its line. No libm: the same bits on every machine.
Carry CarryOf(const ShapePart& now, const ShapePart& next) {
  const cv::Point2d line = now.b - now.a, next_line = next.b - next.a;
  const double length2 = line.dot(line) * next_line.dot(next_line);
  if (now.kind != Kind::kCapsule || !(length2 > 0)) return {now.a, next.a, {1, 0}};
  const cv::Point2d turn(line.dot(next_line), line.x * next_line.y - line.y * next_line.x);
  return {now.a, next.a, turn / std::sqrt(length2)};
}

}  // namespace

double ShapePart::DistanceTo(cv::Point2d place) const {
  if (kind == Kind::kCapsule) {
    const cv::Point2d line = b - a, from_a = place - a;
    const double length2 = line.dot(line),
                 along = length2 > 0 ? std::clamp(from_a.dot(line) / length2, 0.0, 1.0) : 0;
    const cv::Point2d off = from_a - line * along;
    return std::sqrt(off.dot(off)) - radius;
  }
  const cv::Point2d beyond(std::abs(place.x - a.x) - b.x + radius, std::abs(place.y - a.y) - b.y + radius);
  const cv::Point2d outside(std::max(beyond.x, 0.0), std::max(beyond.y, 0.0));
  return std::sqrt(outside.dot(outside)) + std::min(std::max(beyond.x, beyond.y), 0.0) - radius;
}

std::vector<ShapePart> PartsOf(Shape shape, double stride, const cv::Vec3f& colour) {
  switch (shape) {
    case Shape::kBox:
      return Car(colour);
    case Shape::kDisc:
      return Ball(colour);
    case Shape::kWalker:
      return Walker(stride, colour);
  }
  throw std::logic_error("PartsOf: no such shape");
}

std::vector<ShapePart> Mirrored(std::vector<ShapePart> parts) {
  for (ShapePart& part : parts) {
    part.a.x = -part.a.x;
    if (part.kind == Kind::kCapsule) part.b.x = -part.b.x;  // a box's b is its half size
  }
  return parts;
}

Layer DrawParts(const std::vector<ShapePart>& parts, double height_px, const Pose& pose, cv::Rect within) {
  const double unit_px = height_px * pose.scale;
  if (parts.empty() || !(unit_px > 0)) return {};
  const cv::Point2d along = UnitVector(pose.turns),
                    across(-along.y, along.x);  // of the object's x and y on screen
  cv::Point2d low = pose.centre, high = pose.centre;
  std::vector<cv::Rect2d> extents;  // where a part covers anything of a pixel
  for (const ShapePart& part : parts) {
    const cv::Rect2d extent = Extent(part);
    const double px = 1 / unit_px;
    extents.emplace_back(extent.x - px, extent.y - px, extent.width + 2 * px, extent.height + 2 * px);
    for (const double x : {extent.x, extent.x + extent.width})
      for (const double y : {extent.y, extent.y + extent.height}) {
        const cv::Point2d corner = pose.centre + (along * x + across * y) * unit_px;
        low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
        high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
      }
  }
  const cv::Rect area = PixelsWithin(within, low, high);
  if (area.empty()) return {};
  Layer layer{area, cv::Mat::zeros(area.size(), CV_32FC4)};
  for (int y = 0; y < area.height; ++y)
    for (int x = 0; x < area.width; ++x) {
      const cv::Point2d off = (cv::Point2d(area.x + x, area.y + y) - pose.centre) / unit_px;
      const cv::Point2d place(off.dot(along), off.dot(across));
      cv::Vec4f& pixel = layer.rgba.at<cv::Vec4f>(y, x);
      for (size_t i = 0; i < parts.size(); ++i) {
        if (!extents[i].contains(place)) continue;
        const ShapePart& part = parts[i];
        const auto covered = static_cast<float>(std::clamp(0.5 - part.DistanceTo(place) * unit_px, 0.0, 1.0));
        if (covered <= 0) continue;
        const cv::Vec3f& colour = part.colour;
        const float alpha = part.painted ? pixel[3] : 1;
        pixel = pixel * (1 - covered) + cv::Vec4f(colour[0], colour[1], colour[2], 1) * (covered * alpha);
      }
    }
  return layer;
}

cv::Mat PartsFlow(const std::vector<ShapePart>& now, const Pose& pose, const std::vector<ShapePart>& next,
                  const Pose& next_pose, double height_px, cv::Rect area) {
  const double unit_px = height_px * pose.scale;
  const Pose plane{.centre = {0, 0}, .scale = 1 / height_px};  // the object's own, of which the poses are
  cv::Mat flow(area.size(), CV_32FC2, cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  const Carry to_plane(pose, plane), to_next(plane, next_pose);
  std::vector<Carry> parts;
  for (size_t i = 0; i < now.size(); ++i) parts.push_back(CarryOf(now[i], next[i]));
  for (int y = 0; y < area.height; ++y)
    for (int x = 0; x < area.width; ++x) {
      const cv::Point2d pixel(area.x + x, area.y + y), place = to_plane(pixel);
      for (size_t i = now.size(); i-- > 0;) {  // the nearest part first
        if (now[i].painted || now[i].DistanceTo(place) * unit_px > 0) continue;
        const cv::Point2d there = to_next(parts[i](place));
        flow.at<cv::Vec2f>(y, x) = {static_cast<float>(there.x - pixel.x),
                                    static_cast<float>(there.y - pixel.y)};
        break;
      }
    }
  return flow;
}

}  // namespace shimmer::sim
