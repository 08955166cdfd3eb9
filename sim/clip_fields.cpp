#include "sim/clip_fields.h"

#include <algorithm>
#include <vector>

#include "sim/parallel.h"
#include "sim/rows.h"

namespace shimmer::sim {
namespace {

void Clamp(std::span<float> row, float least, float most) {
  for (float& value : row) value = std::min(std::max(value, least), most);
}

}  // namespace

ClipFields::ClipFields(const Scene& scene, const ClipPlan& plan, ClipKey key)
    : scene_(scene), plan_(plan), key_(key), border_px_(plan.blur ? plan.blur->margin_px : 0) {
  const cv::Size size = plan_.shape.size;
  const int border = border_px_;
  if (plan_.tilt) {
    tilt_.emplace(scene_.tilt, key);
    planned_tilt_.emplace(
        *tilt_, plan_.tilt->field,
        noise::PixelArea{-border, -border, size.width + 2 * border, size.height + 2 * border});
  }
  if (plan_.blur && plan_.blur->noise) {
    blur_noise_.emplace(scene_.blur, scene_.tilt.lattice, key);
    planned_noise_.emplace(blur_noise_->octaves(), plan_.blur->field,
                           noise::PixelArea{0, 0, size.width, size.height});
  }
  const bool tilt_stands = plan_.tilt && plan_.tilt->frozen, sigma_stands = plan_.blur && plan_.blur->frozen;
  if (!tilt_stands && !sigma_stands) return;
  Maps maps = Compute(0);
  if (tilt_stands) frozen_.dx = maps.dx, frozen_.dy = maps.dy;
  if (sigma_stands) frozen_.sigma = maps.sigma;
}

ClipFields::Frame ClipFields::At(int64_t t) const {
  Frame frame(*this);
  const bool shifts = planned_tilt_ && frozen_.dx.empty(), noise = planned_noise_ && frozen_.sigma.empty();
  ParallelInvoke(
      [&] {
        if (shifts) frame.x_.emplace(planned_tilt_->x.At(t));
      },
      [&] {
        if (shifts) frame.y_.emplace(planned_tilt_->y.At(t));
      },
      [&] {
        if (noise) frame.noise_.emplace(planned_noise_->At(t));
      });
  return frame;
}

void ClipFields::Frame::Shifts(int y, std::span<float> dx, std::span<float> dy) const {
  const int border_px = clip_->border_px_;
  if (!clip_->frozen_.dx.empty()) {
    std::ranges::copy(RowOf(clip_->frozen_.dx, y + border_px), dx.begin());
    std::ranges::copy(RowOf(clip_->frozen_.dy, y + border_px), dy.begin());
  } else if (x_) {
    x_->Row(y, -border_px, dx);
    y_->Row(y, -border_px, dy);
    // A spline may overshoot; the field does not, and the margin holds its bound.
    const auto most = static_cast<float>(clip_->scene_.tilt.BoundPx());
    Clamp(dx, -most, most);
    Clamp(dy, -most, most);
  } else {
    std::ranges::fill(dx, 0.0f);
    std::ranges::fill(dy, 0.0f);
  }
}

void ClipFields::Frame::Sigmas(int y, std::span<const float> dx, std::span<const float> dy,
                               std::span<float> sigma) const {
  if (!clip_->frozen_.sigma.empty()) {
    std::ranges::copy(RowOf(clip_->frozen_.sigma, y), sigma.begin());
    return;
  }
  const BlurParams& blur = clip_->scene_.blur;
  const std::optional<BlurPlan>& plan = clip_->plan_.blur;
  std::ranges::fill(sigma, plan ? static_cast<float>(blur.min_sigma_px) : 0.0f);
  if (!plan || plan->constant) return;
  const double range_px = blur.max_sigma_px - blur.min_sigma_px;
  if (noise_) {
    thread_local std::vector<float> m;
    m.resize(sigma.size());
    noise_->Row(y, 0, m);
    AddPerlinPart(m, (1 - blur.tilt_weight) * range_px, sigma);
  }
  if (plan->tilt) AddTiltPart(dx, dy, clip_->scene_.tilt.strength_px, blur.tilt_weight * range_px, sigma);
  // Rounding: the margin holds float(max_sigma_px) and no more.
  Clamp(sigma, 0, static_cast<float>(blur.max_sigma_px));
}

ClipFields::Maps ClipFields::Compute(int64_t t) const {
  const cv::Size size = plan_.shape.size,
                 with_border(size.width + 2 * border_px_, size.height + 2 * border_px_);
  Maps maps{cv::Mat(with_border, CV_32F), cv::Mat(with_border, CV_32F), cv::Mat(size, CV_32F)};
  const Frame frame = At(t);
  ParallelFor(-border_px_, size.height + border_px_, [&](int y) {
    const std::span<float> dx = RowOf(maps.dx, y + border_px_), dy = RowOf(maps.dy, y + border_px_);
    frame.Shifts(y, dx, dy);
    if (y < 0 || y >= size.height) return;
    const auto width = static_cast<size_t>(size.width), border = static_cast<size_t>(border_px_);
    frame.Sigmas(y, dx.subspan(border, width), dy.subspan(border, width), RowOf(maps.sigma, y));
  });
  return maps;
}

FrameTruth ClipFields::Truth(int64_t t) const {
  const Maps maps = Compute(t);
  const cv::Rect inside({border_px_, border_px_}, plan_.shape.size);
  FrameTruth truth;
  cv::merge(std::vector{maps.dx(inside), maps.dy(inside)}, truth.tilt);
  truth.sigma = maps.sigma;
  return truth;
}

}  // namespace shimmer::sim
