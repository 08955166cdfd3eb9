#include "sim/clip.h"

#include <tbb/parallel_for.h>

#include <string>

#include "sim/colour.h"
#include "sim/exact_blur.h"
#include "sim/ladder_blur.h"
#include "sim/stack_blur.h"
#include "sim/warp.h"

namespace shimmer::sim {
namespace {

std::span<float> RowOf(cv::Mat& map, int y) { return {map.ptr<float>(y), static_cast<size_t>(map.cols)}; }
std::span<const float> RowOf(const cv::Mat& map, int y) {
  return {map.ptr<float>(y), static_cast<size_t>(map.cols)};
}

// The part of a map or frame that lies border_px within it.
cv::Mat Inside(const cv::Mat& image, int border_px) {
  return image(cv::Rect(border_px, border_px, image.cols - 2 * border_px, image.rows - 2 * border_px));
}

void RequireFrame(const cv::Mat& frame, cv::Size size) {
  if (frame.size() == size && (frame.type() == CV_32FC1 || frame.type() == CV_32FC3)) return;
  throw std::invalid_argument("clean frame of " + std::to_string(frame.cols) + "x" +
                              std::to_string(frame.rows) + " px and type " + cv::typeToString(frame.type()) +
                              ", must be " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                              ", CV_32FC1 or CV_32FC3");
}

}  // namespace

ClipRenderer::ClipRenderer(const Scene& scene, const ClipPlan& plan, ClipKey key)
    : scene_(scene), plan_(plan), border_px_(plan.blur ? plan.blur->margin_px : 0) {
  if (plan_.tilt) tilt_.emplace(scene_.tilt, key);
  if (plan_.blur && plan_.blur->noise) blur_noise_.emplace(scene_.blur, scene_.tilt.lattice, key);
  if (plan_.tilt && plan_.tilt->frozen) frozen_shifts_ = ComputeShifts(0);
  if (plan_.blur && plan_.blur->frozen) frozen_sigma_ = ComputeSigma(0, ComputeShifts(0));
}

ClipRenderer::Shifts ClipRenderer::ComputeShifts(int64_t t) const {
  if (!plan_.tilt) return {};
  if (frozen_shifts_) return *frozen_shifts_;
  const cv::Size with_border(plan_.shape.size.width + 2 * border_px_,
                             plan_.shape.size.height + 2 * border_px_);
  Shifts shifts{cv::Mat(with_border, CV_32F), cv::Mat(with_border, CV_32F)};
  tbb::parallel_for(0, with_border.height, [&](int y) {
    tilt_->Row(t, y - border_px_, -border_px_, RowOf(shifts.dx, y), RowOf(shifts.dy, y));
  });
  return shifts;
}

cv::Mat ClipRenderer::ComputeSigma(int64_t t, const Shifts& shifts) const {
  if (!plan_.blur) return {};
  if (frozen_sigma_) return *frozen_sigma_;
  const BlurParams& blur = scene_.blur;
  const double range_px = blur.max_sigma_px - blur.min_sigma_px;
  cv::Mat map(plan_.shape.size, CV_32F, cv::Scalar(blur.min_sigma_px));
  tbb::parallel_for(0, map.rows, [&](int y) {
    const std::span<float> sigma = RowOf(map, y);
    if (plan_.blur->noise) {
      std::vector<float> m(sigma.size());
      blur_noise_->Row(t, y, 0, m);
      AddPerlinPart(m, (1 - blur.tilt_weight) * range_px, sigma);
    }
    if (plan_.blur->tilt) {
      const auto inside = [&](const cv::Mat& d) {
        return RowOf(d, y + border_px_).subspan(border_px_, sigma.size());
      };
      AddTiltPart(inside(shifts.dx), inside(shifts.dy), scene_.tilt.strength_px, blur.tilt_weight * range_px,
                  sigma);
    }
  });
  return cv::min(map, blur.max_sigma_px);  // rounding: the margin holds float(max_sigma_px) and no more
}

FrameTruth ClipRenderer::TruthOf(const Shifts& shifts, const cv::Mat& sigma) const {
  FrameTruth truth;
  if (plan_.tilt)
    cv::merge(std::vector{Inside(shifts.dx, border_px_), Inside(shifts.dy, border_px_)}, truth.tilt);
  else
    truth.tilt = cv::Mat::zeros(plan_.shape.size, CV_32FC2);
  truth.sigma = plan_.blur ? sigma : cv::Mat(cv::Mat::zeros(plan_.shape.size, CV_32F));
  return truth;
}

FrameTruth ClipRenderer::Truth(int64_t t) const {
  const Shifts shifts = ComputeShifts(t);
  return TruthOf(shifts, ComputeSigma(t, shifts));
}

RenderedFrame ClipRenderer::Render(int64_t t, const cv::Mat& clean_with_halo) const {
  const cv::Size size = plan_.shape.size;
  RequireFrame(clean_with_halo, {size.width + 2 * plan_.halo_px, size.height + 2 * plan_.halo_px});
  const int type = clean_with_halo.type();

  const Shifts shifts = ComputeShifts(t);
  const cv::Mat sigma = ComputeSigma(t, shifts);
  cv::Mat frame = plan_.linear_light ? DecodeSrgb(clean_with_halo) : clean_with_halo;
  if (plan_.tilt) {
    cv::Mat warped(shifts.dx.size(), type);
    tbb::parallel_for(0, warped.rows, [&](int y) {
      const cv::Point first(plan_.tilt->margin_px, y + plan_.tilt->margin_px);
      WarpRow(frame, first, RowOf(shifts.dx, y), RowOf(shifts.dy, y), scene_.tilt.interpolation,
              warped.ptr<float>(y));
    });
    frame = warped;
  }
  if (plan_.blur) {
    cv::Mat blurred(size, type);
    std::optional<BlurStack> stack;
    std::optional<LadderBlur> mixtures;
    if (plan_.blur->way == BlurWay::kStack)
      stack.emplace(frame, scene_.blur.min_sigma_px, scene_.blur.max_sigma_px);
    if (plan_.blur->way == BlurWay::kLadder)
      mixtures.emplace(frame, LevelLadder::For(scene_.blur.max_sigma_px));
    tbb::parallel_for(0, size.height, [&](int y) {
      const cv::Point first(border_px_, y + border_px_);
      if (mixtures)
        mixtures->Row(first, RowOf(sigma, y), blurred.ptr<float>(y));
      else if (stack)
        stack->Row({0, y}, RowOf(sigma, y), scene_.blur.level_choice, blurred.ptr<float>(y));
      else
        ExactBlurRow(frame, first, RowOf(sigma, y), blurred.ptr<float>(y));
    });
    frame = blurred;
  }
  if (frame.data == clean_with_halo.data) frame = frame.clone();  // the result is the caller's to change
  return {plan_.linear_light ? EncodeSrgb(frame) : frame, TruthOf(shifts, sigma)};
}

}  // namespace shimmer::sim
