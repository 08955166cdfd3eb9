#include "sim/app/scene_marks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "cli/number_text.h"

namespace shimmer::app {
namespace {

constexpr double kCovered = 0.5;
constexpr int kLeastInset = 28, kMostInset = 90, kInsetGap = 5;  // px
constexpr int kDot = 3;                                          // px, of the current place
constexpr int kFineBits = 4;  // lines are drawn between pixels too: to 1/16 px

cv::Scalar AsScalar(const cv::Vec3b& colour) { return cv::Scalar(colour[0], colour[1], colour[2]); }

void CheckShown(const cv::Mat& shown) {
  if (shown.type() != CV_8UC3) throw std::invalid_argument("picture to mark must be CV_8UC3");
}

// Pixels as shown of which any part is covered: what is small must not vanish as the picture shrinks.
cv::Mat CoveredAsShown(const cv::Mat& mask, cv::Size size) {
  cv::Mat covered = mask >= kCovered, shown;
  const bool shrinks = size.width < mask.cols || size.height < mask.rows;
  cv::resize(covered, shown, size, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_NEAREST);
  return shown > 0;
}

void Paint(cv::Mat& shown, const cv::Mat& where, cv::Point by, const cv::Vec3b& colour) {
  const cv::Rect frame({}, shown.size()), seen = (frame + by) & frame;
  if (!seen.empty()) shown(seen).setTo(AsScalar(colour), where(seen - by));
}

double Furthest(std::span<const cv::Point2d> path_px) {
  double furthest_px = 0;
  for (const cv::Point2d& s : path_px) furthest_px = std::max(furthest_px, std::hypot(s.x, s.y));
  return furthest_px;
}

}  // namespace

bool SceneMarks::HasPath() const { return Furthest(path_px) > 0; }

std::string SceneMarks::Label() const {
  return HasPath() ? "shake up to " + cli::ShortText(Furthest(path_px)) + " px" : "";
}

void DrawOutline(cv::Mat& shown, const cv::Mat& mask, cv::Point2d shake_px) {
  CheckShown(shown);
  if (mask.type() != CV_32FC1) throw std::invalid_argument("mask to outline must be CV_32FC1");
  const double x = shake_px.x * shown.cols / mask.cols, y = shake_px.y * shown.rows / mask.rows;
  if (!(std::abs(x) < shown.cols && std::abs(y) < shown.rows)) return;  // nothing of it is seen
  const cv::Point by(cvRound(x), cvRound(y));
  const cv::Mat covered = CoveredAsShown(mask, shown.size());
  // Found before it is moved: what comes in from beyond the frame is not known, and would be an edge.
  cv::Mat inner, around;
  cv::erode(covered, inner, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  cv::dilate(covered, around, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  Paint(shown, around & ~covered, by, kOutlineShadow);
  Paint(shown, covered & ~inner, by, kOutline);
}

cv::Rect ShakeInsetArea(cv::Size shown) {
  const int shorter = std::min(shown.width, shown.height);
  if (shorter < 2 * kLeastInset) return {};
  const int side = std::clamp(shorter / 3, kLeastInset, kMostInset) | 1;  // odd: it has a middle
  return {shown.width - kInsetGap - side, kInsetGap, side, side};
}

void DrawShakeInset(cv::Mat& shown, std::span<const cv::Point2d> path_px, size_t place) {
  CheckShown(shown);
  if (place >= path_px.size()) throw std::invalid_argument("place is not on the camera's path");
  const cv::Rect area = ShakeInsetArea(shown.size());
  const double furthest_px = Furthest(path_px);
  if (area.empty() || !(furthest_px > 0)) return;
  cv::Mat inset = shown(area);
  inset.convertTo(inset, -1, 0.25, 10);
  const int middle = area.width / 2;
  const cv::Scalar faint(120, 120, 120);
  cv::rectangle(inset, cv::Rect({}, area.size()), faint, 1);
  cv::line(inset, {middle, kDot}, {middle, area.height - 1 - kDot}, faint * 0.6, 1);
  cv::line(inset, {kDot, middle}, {area.width - 1 - kDot, middle}, faint * 0.6, 1);

  const double scale = (middle - kDot - 2) / furthest_px;  // the dot stays within, too
  const auto fine = [&](const cv::Point2d& s) {
    return cv::Point(cvRound((middle + s.x * scale) * (1 << kFineBits)),
                     cvRound((middle + s.y * scale) * (1 << kFineBits)));
  };
  for (size_t k = 1; k < path_px.size(); ++k)
    cv::line(inset, fine(path_px[k - 1]), fine(path_px[k]), AsScalar(kShakePath), 1, cv::LINE_AA, kFineBits);
  const cv::Point dot = fine(path_px[place]);
  cv::circle(inset, dot, (kDot + 1) << kFineBits, cv::Scalar::all(0), cv::FILLED, cv::LINE_AA, kFineBits);
  cv::circle(inset, dot, kDot << kFineBits, AsScalar(kShakePlace), cv::FILLED, cv::LINE_AA, kFineBits);
}

void MarkClean(cv::Mat& shown, const SceneMarks& marks) {
  if (!marks.mask.empty() && marks.clean_shake_px) DrawOutline(shown, marks.mask, *marks.clean_shake_px);
}

void MarkTurb(cv::Mat& shown, const SceneMarks& marks) {
  if (!marks.mask.empty() && marks.turb_shake_px) DrawOutline(shown, marks.mask, *marks.turb_shake_px);
  if (marks.HasPath()) DrawShakeInset(shown, marks.path_px, marks.place);
}

}  // namespace shimmer::app
