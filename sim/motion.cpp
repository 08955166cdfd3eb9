#include "sim/motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "noise/portable_math.h"
#include "sim/size_text.h"
#include "sim/unit_vector.h"

namespace shimmer::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr int kStepsBetweenPoints = 256;  // corners of the polygon lie within 1e-4 of the spline's bends

cv::Point2d OfFrame(cv::Point2d share, cv::Size frame) {
  return {share.x * frame.width - 0.5, share.y * frame.height - 0.5};
}

std::string PlaceText(cv::Point2d place) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.1f, %.1f)", place.x, place.y);
  return text;
}

// Catmull-Rom through the points; beyond the ends it goes on as it came.
cv::Point2d SplineAt(const std::vector<cv::Point2d>& points, size_t i, double t) {
  const cv::Point2d b = points[i], c = points[i + 1], a = i > 0 ? points[i - 1] : b * 2 - c,
                    d = i + 2 < points.size() ? points[i + 2] : c * 2 - b;
  return b + ((c - a) + ((a * 2 - b * 5 + c * 4 - d) + (b * 3 - a - c * 3 + d) * t) * t) * (0.5 * t);
}

}  // namespace

Carry::Carry(const Pose& from_, const Pose& to_)
    : from(from_.centre),
      to(to_.centre),
      turn(UnitVector(to_.turns - from_.turns) * (to_.scale / from_.scale)) {}

Motion::Motion(const MotionParams& params, cv::Size frame, int64_t frames)
    : params_(params),
      start_(OfFrame({params.start_x, params.start_y}, frame)),
      along_(UnitVector(params.direction_deg / 360)) {
  if (params.path == PathKind::kArc && params.radius_px == 0)
    throw std::invalid_argument("radius_px = 0, an arc must have a radius");
  if (params.path == PathKind::kSpline) DrawSpline(frame);
  if (params.off_frame != OffFrame::kAllow) KeepWithin(frame, frames);
}

void Motion::DrawSpline(cv::Size frame) {
  if (params_.points.size() < 2)
    throw std::invalid_argument("points: has " + std::to_string(params_.points.size()) +
                                ", a spline must have at least two");
  std::vector<cv::Point2d> points;
  for (const cv::Point2d& point : params_.points) points.push_back(OfFrame(point, frame));
  spline_ = {points.front()};
  way_px_ = {0};
  for (size_t i = 0; i + 1 < points.size(); ++i)
    for (int step = 1; step <= kStepsBetweenPoints; ++step) {
      const cv::Point2d corner = SplineAt(points, i, static_cast<double>(step) / kStepsBetweenPoints);
      way_px_.push_back(way_px_.back() + cv::norm(corner - spline_.back()));
      spline_.push_back(corner);
    }
}

// By the places of all frames.
void Motion::KeepWithin(cv::Size frame, int64_t frames) {
  const cv::Point2d least(-0.5, -0.5), most(frame.width - 0.5, frame.height - 0.5);
  cv::Point2d low = most, high = least;
  for (int64_t k = 0; k < frames; ++k) {
    const cv::Point2d place = PlaceAt(static_cast<double>(k));
    const bool off = place.x < least.x || place.y < least.y || place.x > most.x || place.y > most.y;
    if (off && params_.off_frame == OffFrame::kRefuse)
      throw std::invalid_argument("leaves the scene: in frame " + std::to_string(k) + " its middle is at " +
                                  PlaceText(place) + " px, must be within " + SizeText(frame) +
                                  " px (off_frame \"shift\" moves the path, \"allow\" lets it go)");
    low = k == 0 ? place : cv::Point2d(std::min(low.x, place.x), std::min(low.y, place.y));
    high = k == 0 ? place : cv::Point2d(std::max(high.x, place.x), std::max(high.y, place.y));
  }
  if (high.x - low.x > frame.width || high.y - low.y > frame.height)
    throw std::invalid_argument("leaves the scene: its path is " + PlaceText(high - low) +
                                " px wide and high, must be within " + SizeText(frame) + " px");
  const cv::Point2d before = least - low, beyond = high - most;
  shift_ = {std::max(before.x, 0.0) - std::max(beyond.x, 0.0),
            std::max(before.y, 0.0) - std::max(beyond.y, 0.0)};
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

bool Motion::BeginsLeftward() const {
  constexpr double kMoment_frames = 1e-3, kUpright = 1e-6;  // a direction of 90 degrees leans by rounding
  const cv::Point2d way = PlaceAt(kMoment_frames) - PlaceAt(0);
  return way.x < -kUpright * cv::norm(way);
}

Pose Motion::At(double time) const {
  constexpr double kMostLog = 14;
  const double log_scale = std::clamp(noise::Log(params_.scale_rate) * time, -kMostLog, kMostLog);
  return {.centre = PlaceAt(time) + shift_,
          .scale = params_.scale_rate == 1 ? 1 : noise::Exp(log_scale),
          .turns = (params_.rotation_deg + params_.rotation_rate * time) / 360};
}

}  // namespace shimmer::sim
