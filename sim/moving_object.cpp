#include "sim/moving_object.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shimmer::sim {
namespace {

constexpr double kStrideHeights = 0.9;
constexpr int kMostSnapshots = 64;
constexpr double kSnapshotStep_px = 0.5;  // edges of snapshots so near show as one slope

}  // namespace

MovingObject::MovingObject(Look look, const MotionParams& motion, cv::Size frame, int64_t frames,
                           double height_px, double shutter)
    : look_(std::move(look)),
      motion_(motion, frame, frames),
      speed_px_(motion.speed_px),
      height_px_(height_px),
      shutter_(shutter),
      faces_left_(motion_.BeginsLeftward()) {}

std::vector<ShapePart> MovingObject::PartsAt(const DrawnLook& look, double time) const {
  const double stride = height_px_ > 0 ? speed_px_ * time / (kStrideHeights * height_px_) : 0;
  std::vector<ShapePart> parts = PartsOf(look.shape, stride, look.colour);
  return faces_left_ ? Mirrored(std::move(parts)) : parts;
}

const Cutout* MovingObject::CutoutAt(int64_t frame, std::shared_ptr<const Cutout>& keeper) const {
  keeper = std::holds_alternative<StillLook>(look_) ? std::get<StillLook>(look_)
                                                    : std::get<VideoLook>(look_)(frame);
  return keeper.get();
}

Layer MovingObject::Snapshot(double time, int64_t frame, cv::Rect within) const {
  const Pose pose = motion_.At(time);
  if (const auto* drawn = std::get_if<DrawnLook>(&look_))
    return DrawParts(PartsAt(*drawn, time), height_px_, pose, within);
  std::shared_ptr<const Cutout> keeper;
  return CutoutAt(frame, keeper)->Draw(height_px_, pose, within);
}

// As many that none of the object's outermost places goes further than a step from one to the next.
int MovingObject::SnapshotsAt(int64_t k) const {
  if (shutter_ <= 0) return 1;
  const auto time = static_cast<double>(k);
  const Pose first = motion_.At(time - shutter_ / 2), last = motion_.At(time + shutter_ / 2);
  double way_px = 0;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const cv::Point2d corner = first.centre + cv::Point2d(x, y) * (height_px_ * first.scale);
      way_px = std::max(way_px, cv::norm(Moved(corner, first, last) - corner));
    }
  return std::clamp(static_cast<int>(std::ceil(way_px / kSnapshotStep_px)), 1, kMostSnapshots);
}

Layer MovingObject::At(int64_t k, cv::Rect within) const {
  const int snapshots = SnapshotsAt(k);
  LayerMean mean;
  for (int i = 0; i < snapshots; ++i) {
    const double share = (i + 0.5) / snapshots - 0.5;  // of the shutter's time
    mean.Add(Snapshot(static_cast<double>(k) + shutter_ * share, k, within));
  }
  return mean.Mean();
}

cv::Mat MovingObject::FlowAt(int64_t k, cv::Rect area) const {
  const auto time = static_cast<double>(k);
  const Pose now = motion_.At(time), next = motion_.At(time + 1);
  if (const auto* drawn = std::get_if<DrawnLook>(&look_))
    return PartsFlow(PartsAt(*drawn, time), now, PartsAt(*drawn, time + 1), next, height_px_, area);
  cv::Mat flow(area.size(), CV_32FC2, cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  const Layer layer = Snapshot(time, k, area);
  const cv::Rect seen = layer.area;
  const Carry carry(now, next);
  for (int y = seen.y; y < seen.br().y; ++y)
    for (int x = seen.x; x < seen.br().x; ++x) {
      if (layer.rgba.at<cv::Vec4f>(y - layer.area.y, x - layer.area.x)[3] < 0.5f) continue;
      const cv::Point2d way = carry(cv::Point2d(x, y)) - cv::Point2d(x, y);
      flow.at<cv::Vec2f>(y - area.y, x - area.x) = {static_cast<float>(way.x), static_cast<float>(way.y)};
    }
  return flow;
}

}  // namespace shimmer::sim
