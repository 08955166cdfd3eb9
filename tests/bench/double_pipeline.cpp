#include "tests/bench/double_pipeline.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "noise/simplex_double.h"
#include "sim/exact_blur.h"
#include "sim/warp.h"

namespace shimmer::bench {
namespace {

bool OnFace(const noise::SimplexOctaves& octaves, int64_t t, int64_t y, int64_t x) {
  constexpr double kNearCells = 1e-6;
  return std::ranges::any_of(octaves.octaves(), [&](const noise::Octave& octave) {
    const auto cells = [](noise::Fixed place) { return place.Reduced().ToDouble(); };
    return noise::SimplexFaceDistance(cells(octave.origin[0] + octave.step_px * x),
                                      cells(octave.origin[1] + octave.step_px * y),
                                      cells(octave.origin[2] + octave.step_frame * t)) < kNearCells;
  });
}

}  // namespace

ExactShifts ExactTilt(const sim::TiltField& field, cv::Size size, int border_px, int64_t t) {
  const cv::Size with_border(size.width + 2 * border_px, size.height + 2 * border_px);
  ExactShifts shifts{cv::Mat(with_border, CV_64F), cv::Mat(with_border, CV_64F)};
  tbb::parallel_for(0, with_border.height, [&](int y) {
    for (int x = 0; x < with_border.width; ++x) {
      const sim::TiltField::Shift shift = field.Double(t, y - border_px, x - border_px);
      shifts.dx.at<double>(y, x) = shift.x;
      shifts.dy.at<double>(y, x) = shift.y;
    }
  });
  return shifts;
}

cv::Mat ExactSigma(const sim::Scene& scene, const sim::BlurNoise& noise, const ExactShifts& shifts,
                   int border_px, int64_t t) {
  const sim::BlurParams& blur = scene.blur;
  cv::Mat sigma(shifts.dx.rows - 2 * border_px, shifts.dx.cols - 2 * border_px, CV_32F);
  tbb::parallel_for(0, sigma.rows, [&](int y) {
    for (int x = 0; x < sigma.cols; ++x) {
      const double tilt01 =
          sim::Tilt01(shifts.dx.at<double>(y + border_px, x + border_px),
                      shifts.dy.at<double>(y + border_px, x + border_px), scene.tilt.strength_px);
      const double share =
          (1 - blur.tilt_weight) * sim::Perlin01(noise.Double(t, y, x)) + blur.tilt_weight * tilt01;
      sigma.at<float>(y, x) =
          static_cast<float>(blur.min_sigma_px + (blur.max_sigma_px - blur.min_sigma_px) * share);
    }
  });
  return sigma;
}

double CatmullRom(const cv::Mat& plane, double x, double y) {
  // WarpDouble copies the plane that it is given: it gets the few pixels that it reads.
  const int left = static_cast<int>(std::floor(x)) - 1, top = static_cast<int>(std::floor(y)) - 1;
  return sim::WarpDouble(plane(cv::Rect(left, top, 4, 4)), x - left, y - top, 0,
                         sim::Interpolation::kBicubic);
}

cv::Mat ExactWarp(const cv::Mat& clean, int margin_px, const ExactShifts& shifts, const ReadPlane& read) {
  std::vector<cv::Mat> planes;
  cv::split(clean, planes);
  cv::Mat warped(shifts.dx.size(), clean.type());
  tbb::parallel_for(0, warped.rows, [&](int y) {
    float* out = warped.ptr<float>(y);
    for (int x = 0; x < warped.cols; ++x)
      for (const cv::Mat& plane : planes)
        *out++ = static_cast<float>(read(plane, x + margin_px + shifts.dx.at<double>(y, x),
                                         y + margin_px + shifts.dy.at<double>(y, x)));
  });
  return warped;
}

cv::Mat ExactBlur(const cv::Mat& frame, int border_px, const cv::Mat& sigma) {
  cv::Mat blurred(sigma.size(), frame.type());
  tbb::parallel_for(0, sigma.rows, [&](int y) {
    sim::ExactBlurRow(frame, {border_px, y + border_px},
                      {sigma.ptr<float>(y), static_cast<size_t>(sigma.cols)}, blurred.ptr<float>(y));
  });
  return blurred;
}

cv::Mat OnFaces(const sim::TiltField& field, cv::Size size, int64_t t) {
  cv::Mat faces(size, CV_8U, cv::Scalar(0));
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x)
      if (OnFace(field.x(), t, y, x) || OnFace(field.y(), t, y, x)) faces.at<uchar>(y, x) = 255;
  });
  return faces;
}

Error ErrorOf(const cv::Mat& a, const cv::Mat& b, const cv::Mat& without) {
  cv::Mat a64, b64;
  a.convertTo(a64, CV_64F);
  b.convertTo(b64, CV_64F);
  CV_Assert(a64.size() == b64.size() && a64.type() == b64.type());
  double squares = 0, count = 0;
  Error error;
  for (int y = 0; y < a64.rows; ++y)
    for (int x = 0; x < a64.cols; ++x) {
      if (!without.empty() && without.at<uchar>(y, x)) continue;
      for (int c = 0; c < a64.channels(); ++c, ++count) {
        const int i = x * a64.channels() + c;
        const double off = std::abs(a64.ptr<double>(y)[i] - b64.ptr<double>(y)[i]);
        if (std::isnan(off)) return {NAN, NAN};
        squares += off * off;
        error.max = std::max(error.max, off);
      }
    }
  error.rms = std::sqrt(squares / std::max(count, 1.0));
  return error;
}

}  // namespace shimmer::bench
