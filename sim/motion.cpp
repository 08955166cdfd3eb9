#include "sim/motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "noise/portable_math.h"
#include "sim/unit_vector.h"

namespace shimmer::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr int kStepsBetweenPoints = 256;  // corners of the polygon lie within 1e-4 of the spline's bends

cv::Point2d OfFrame(cv::Point2d share, cv::Size frame) {
  return {share.x * frame.width - 0.5, share.y * frame.height - 0.5};
}

// Catmull-Rom through the points; beyond the ends it goes on as it came.
cv::Point2d SplineAt(const std::vector<cv::Point2d>& points, size_t i, double t) {
  const cv::Point2d b = points[i], c = points[i + 1], a = i > 0 ? points[i - 1] : b * 2 - c,
                    d = i + 2 < points.size() ? points[i + 2] : c * 2 - b;
  return b + ((c - a) + ((a * 2 - b * 5 + c * 4 - d) + (b * 3 - a - c * 3 + d) * t) * t) * (0.5 * t);
}

}  // namespace

cv::Point2d Moved(cv::Point2d place, const Pose& from, const Pose& to) {
  const cv::Point2d turned = UnitVector(to.turns - from.turns) * (to.scale / from.scale),
                    off = place - from.centre;
  return to.centre + cv::Point2d(off.x * turned.x - off.y * turned.y, off.x * turned.y + off.y * turned.x);
}

Motion::Motion(const MotionParams& params, cv::Size frame)
    : params_(params),
      start_(OfFrame({params.start_x, params.start_y}, frame)),
      along_(UnitVector(params.direction_deg / 360)) {
  if (params.path == PathKind::kArc && params.radius_px == 0)
    throw std::invalid_argument("radius_px = 0, an arc must have a radius");
  if (params.path != PathKind::kSpline) return;
  if (params.points.size() < 2)
    throw std::invalid_argument("points: has " + std::to_string(params.points.size()) +
                                ", a spline must have at least two");
  std::vector<cv::Point2d> points;
  for (const cv::Point2d& point : params.points) points.push_back(OfFrame(point, frame));
  spline_ = {points.front()};
  way_px_ = {0};
  for (size_t i = 0; i + 1 < points.size(); ++i)
    for (int step = 1; step <= kStepsBetweenPoints; ++step) {
      const cv::Point2d corner = SplineAt(points, i, static_cast<double>(step) / kStepsBetweenPoints);
      way_px_.push_back(way_px_.back() + cv::norm(corner - spline_.back()));
      spline_.push_back(corner);
    }
}

cv::Point2d Motion::OnSpline(double way_px) const {
  const auto after = std::ranges::upper_bound(way_px_, way_px);
  if (after == way_px_.end()) return spline_.back();
  const auto i = static_cast<size_t>(after - way_px_.begin());
  const double share = (way_px - way_px_[i - 1]) / (way_px_[i] - way_px_[i - 1]);
  return spline_[i - 1] + (spline_[i] - spline_[i - 1]) * share;
}

cv::Point2d Motion::PlaceAt(double time) const {
  const double way_px = params_.speed_px * time;
  switch (params_.path) {
    case PathKind::kLine:
      return start_ + along_ * way_px;
    case PathKind::kArc: {
      // About a centre on the right hand, that is clockwise on screen
      const cv::Point2d outward = cv::Point2d(along_.y, -along_.x) * params_.radius_px;
      const cv::Point2d centre = start_ - outward;
      return Moved(start_, {.centre = centre},
                   {.centre = centre, .turns = way_px / (kTurn * params_.radius_px)});
    }
    case PathKind::kSpline:
      return OnSpline(std::max(way_px, 0.0));
    case PathKind::kSway:
      return start_ + along_ * (params_.sway_px * UnitVector(time / params_.period_frames).y);
  }
  throw std::logic_error("Motion: no such path");
}

Pose Motion::At(double time) const {
  return {.centre = PlaceAt(time),
          .scale = params_.scale_rate == 1 ? 1 : noise::Exp(noise::Log(params_.scale_rate) * time),
          .turns = (params_.rotation_deg + params_.rotation_rate * time) / 360};
}

}  // namespace shimmer::sim
