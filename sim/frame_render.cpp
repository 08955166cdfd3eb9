#include "sim/frame_render.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "sim/colour.h"
#include "sim/frame_blur.h"
#include "sim/gaussian.h"
#include "sim/pack_rows.h"
#include "sim/parallel.h"
#include "sim/row_sums.h"
#include "sim/rows.h"
#include "sim/warp.h"

namespace shimmer::sim {
namespace {

constexpr int kBand_px = 16;  // rows that one task works on

using PlaneRows = std::array<float*, 3>;

// Rows of floats that a thread keeps.
std::span<float> Scratch(size_t which, size_t size) {
  thread_local std::array<std::vector<float>, 6> rows;
  rows[which].resize(std::max(rows[which].size(), size));
  return {rows[which].data(), size};
}

void Multiply(std::span<float> row, std::span<const float> by) {
  for (size_t i = 0; i < row.size(); ++i) row[i] *= by[i];
}

class FrameRender {
 public:
  FrameRender(const Scene& scene, const ClipPlan& plan, const ClipFields& fields, int64_t t,
              const CleanFrame& clean, const FrameView& view, FrameMemory& memory, RenderedFrame& out)
      : scene_(scene),
        plan_(plan),
        fields_(fields.At(t)),
        key_(fields.key()),
        t_(t),
        clean_(clean),
        view_(view),
        origin_(-WholeShake(view.shake_px) - clean.origin),
        fraction_(view.shake_px - cv::Point2d(WholeShake(view.shake_px))),
        border_px_(fields.border_px()),
        size_(plan.shape.size),
        memory_(memory),
        out_(out) {}

  // Shifts, sigmas and warped pixels of a band of rows; without a blur, its pixels are done.
  void Warp() {
    const cv::Size with_border(size_.width + 2 * border_px_, size_.height + 2 * border_px_);
    if (plan_.blur) {
      memory_.warped.resize(clean_.grey ? 1 : 3);
      for (cv::Mat& plane : memory_.warped) plane.create(with_border, CV_32F);
      memory_.sigma.create(size_, CV_32F);
    }
    std::vector<double> tilt_sums(static_cast<size_t>(size_.height)), sigma_sums(tilt_sums.size());
    ForBands(-border_px_, size_.height + border_px_, [&](int begin, int end) {
      std::vector<cv::Range> varied;  // nowhere, if nothing is done to the clip at all
      if (plan_.tilt || plan_.blur || plan_.shake || plan_.sensor)
        varied = Varied({SourceX(-border_px_), SourceY(begin), with_border.width, end - begin}, TiltReach());
      for (int y = begin; y < end; ++y) WarpRowOf(y, varied, tilt_sums, sigma_sums);
    });
    const double pixels = static_cast<double>(size_.area());
    double tilt = 0, sigma = 0;
    for (const double sum : tilt_sums) tilt += sum;
    for (const double sum : sigma_sums) sigma += sum;
    out_.tilt_square_px2 = tilt / (2 * pixels);
    out_.mean_sigma_px = sigma / pixels;
  }

  void Blur() {
    const FrameBlur blur(memory_.warped, scene_.blur, *plan_.blur);
    ForBands(0, size_.height, [&](int begin, int end) {
      const std::vector<cv::Range> varied =
          Varied({SourceX(0), SourceY(begin), size_.width, end - begin}, TiltReach() + BlurReach());
      for (int y = begin; y < end; ++y) CopyRow(y, varied);
      thread_local Planes blurred;
      blurred.resize(memory_.warped.size());
      for (const cv::Range& part : varied) {
        for (cv::Mat& plane : blurred) plane.create(end - begin, part.size(), CV_32F);
        blur.Band({part.start + border_px_, begin + border_px_}, memory_.sigma(cv::Range(begin, end), part),
                  blurred);
        for (int y = begin; y < end; ++y) {
          PlaneRows rows{};
          for (size_t c = 0; c < blurred.size(); ++c) rows[c] = blurred[c].ptr<float>(y - begin);
          Finish(y, part, rows);
        }
      }
    });
  }

 private:
  template <class F>
  static void ForBands(int begin, int end, const F& f) {
    const int bands = (end - begin + kBand_px - 1) / kBand_px;
    ParallelFor(0, bands, [&](int band) {
      const int first = begin + band * kBand_px;
      f(first, std::min(first + kBand_px, end));
    });
  }

  // Where something may change: all of it, where a sensor looks at it.
  std::vector<cv::Range> Varied(cv::Rect area, int reach_px) const {
    if (plan_.sensor) return {cv::Range(0, area.width)};
    return clean_.constant.Varied(area, reach_px);
  }

  int SourceX(int x) const { return x + origin_.x; }
  int SourceY(int y) const { return y + origin_.y; }
  // Where the blur sees nothing but one colour: further than its margin, for what is left of the light there
  // would show as a step.
  int BlurReach() const { return GaussianRadius(scene_.blur.max_sigma_px); }
  int TiltReach() const { return plan_.WarpMargin(); }

  void WarpRowOf(int y, const std::vector<cv::Range>& varied, std::vector<double>& tilt_sums,
                 std::vector<double>& sigma_sums) {
    const auto border = static_cast<size_t>(border_px_), width = static_cast<size_t>(size_.width);
    const std::span<float> dx = Scratch(3, width + 2 * border), dy = Scratch(4, width + 2 * border);
    fields_.Shifts(y, dx, dy);
    const bool inside = y >= 0 && y < size_.height;
    const std::span<float> own_dx = dx.subspan(border, width), own_dy = dy.subspan(border, width);
    std::span<float> sigma;
    if (inside) {
      sigma = plan_.blur ? RowOf(memory_.sigma, y) : Scratch(5, width);
      fields_.Sigmas(y, own_dx, own_dy, sigma);
    }
    if (plan_.own_distances) {
      const std::span<const float> strength = RowOf(view_.strength, y + border_px_);
      Multiply(dx, strength), Multiply(dy, strength);
      if (inside) Multiply(sigma, strength.subspan(border, width));
    }
    if (inside) {
      const auto row = static_cast<size_t>(y);
      tilt_sums[row] = SumOfSquares(own_dx) + SumOfSquares(own_dy);
      sigma_sums[row] = SumOfRow(sigma);
      if (out_.truth) KeepTruth(y, own_dx, own_dy, sigma);
    }
    if (plan_.shake) {  // all but its whole px, which moves what is read (SourceX)
      for (float& shift : dx) shift -= fraction_.x;
      for (float& shift : dy) shift -= fraction_.y;
    }
    if (!plan_.blur) CopyRow(y, varied);
    for (const cv::Range& part : varied) {
      const auto start = static_cast<size_t>(part.start), length = static_cast<size_t>(part.size());
      PlaneRows rows{};
      for (size_t c = 0; c < (clean_.grey ? 1 : 3); ++c)
        rows[c] =
            plan_.blur ? memory_.warped[c].ptr<float>(y + border_px_) + start : Scratch(c, length).data();
      const cv::Point first(SourceX(part.start - border_px_), SourceY(y));
      if (plan_.tilt || plan_.shake)
        WarpRow(clean_.source, first, dx.subspan(start, length), dy.subspan(start, length),
                scene_.tilt.interpolation, rows.data());
      else
        UnpackRow(clean_.light, first, length, rows.data());
      if (!plan_.blur) Finish(y, part, rows);
    }
    if (plan_.blur) FillConstant(y, varied);
  }

  // Where all is constant that the tilt can reach, shifts change nothing.
  void FillConstant(int y, const std::vector<cv::Range>& varied) {
    ForTheRest(varied, size_.width + 2 * border_px_, [&](const cv::Range& part) {
      PlaneRows rows{};
      for (size_t c = 0; c < memory_.warped.size(); ++c)
        rows[c] = memory_.warped[c].ptr<float>(y + border_px_) + part.start;
      UnpackRow(clean_.light, {SourceX(part.start - border_px_), SourceY(y)},
                static_cast<size_t>(part.size()), rows.data());
    });
  }

  // Pixels that nothing can change, as they were given.
  void CopyRow(int y, const std::vector<cv::Range>& varied) {
    ForTheRest(varied, size_.width, [&](const cv::Range& part) {
      std::memcpy(out_.turb.ptr(y, part.start), clean_.samples.ptr(SourceY(y), SourceX(part.start)),
                  static_cast<size_t>(part.size()) * out_.turb.elemSize());
    });
  }

  template <class F>
  static void ForTheRest(const std::vector<cv::Range>& varied, int width, const F& f) {
    int done = 0;
    for (const cv::Range& part : varied) {
      if (part.start > done) f(cv::Range(done, part.start));
      done = part.end;
    }
    if (done < width) f(cv::Range(done, width));
  }

  void KeepTruth(int y, std::span<const float> dx, std::span<const float> dy, std::span<const float> sigma) {
    auto* tilt = out_.truth->tilt.ptr<cv::Vec2f>(y);
    for (size_t x = 0; x < dx.size(); ++x) tilt[x] = {dx[x], dy[x]};
    std::ranges::copy(sigma, out_.truth->sigma.ptr<float>(y));
  }

  // Float light to the samples of the frame that was given.
  void Finish(int y, const cv::Range& part, const PlaneRows& rows) {
    const auto length = static_cast<size_t>(part.size());
    const size_t planes = clean_.grey ? 1 : 3;
    if (plan_.sensor)
      for (size_t c = 0; c < planes; ++c)
        SenseRow(scene_.sensor, key_, t_, y, static_cast<int>(c), part.start, {rows[c], length});
    if (plan_.linear_light)
      for (size_t c = 0; c < planes; ++c) EncodeSrgbRow({rows[c], length});
    PackRow(std::span<const float* const>(rows.data(), planes), length, {part.start, y}, out_.turb);
  }

  const Scene& scene_;
  const ClipPlan& plan_;
  const ClipFields::Frame fields_;
  const ClipKey key_;
  const int64_t t_;
  const CleanFrame& clean_;
  const FrameView& view_;
  const cv::Point origin_;      // of the clip in the clean frame's pixels
  const cv::Point2f fraction_;  // of the shake, beside its whole px
  const int border_px_;
  const cv::Size size_;
  FrameMemory& memory_;
  RenderedFrame& out_;
};

}  // namespace

void RenderFrame(const Scene& scene, const ClipPlan& plan, const ClipFields& fields, int64_t t,
                 const CleanFrame& clean, const FrameView& view, bool with_truth, FrameMemory& memory,
                 RenderedFrame& out) {
  const cv::Size size = plan.shape.size;
  out.turb.create(size, clean.samples.type());
  if (with_truth) {
    if (!out.truth) out.truth.emplace();
    out.truth->tilt.create(size, CV_32FC2);
    out.truth->sigma.create(size, CV_32FC1);
  } else {
    out.truth.reset();
  }
  FrameRender frame(scene, plan, fields, t, clean, view, memory, out);
  frame.Warp();
  if (plan.blur) frame.Blur();
}

}  // namespace shimmer::sim
