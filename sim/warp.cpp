#include "sim/warp.h"

#include <array>
#include <cmath>

#include "sim/bicubic.h"

namespace shimmer::sim {
namespace {

// Weights of the pixels first .. first + N - 1 from floor(place), for the fraction t of the place.
struct Nearest {
  static constexpr int kFirst = 0, kTaps = 2;
  template <class Real>
  static std::array<Real, 2> Weights(Real t) {
    return {Real(t < Real(0.5)), Real(t >= Real(0.5))};
  }
};

struct Bilinear {
  static constexpr int kFirst = 0, kTaps = 2;
  template <class Real>
  static std::array<Real, 2> Weights(Real t) {
    return {1 - t, t};
  }
};

struct CatmullRom {
  static constexpr int kFirst = -1, kTaps = 4;
  template <class Real>
  static std::array<Real, 4> Weights(Real t) {
    const Real half = Real(0.5);
    return {half * t * ((2 - t) * t - 1), half * ((3 * t - 5) * t * t + 2), half * t * ((4 - 3 * t) * t + 1),
            half * t * t * (t - 1)};
  }
};

template <class Kernel, int kChannels, class Real>
void Sample(const cv::Mat& frame, int x, int y, Real fraction_x, Real fraction_y, Real* out) {
  const auto weights_x = Kernel::Weights(fraction_x), weights_y = Kernel::Weights(fraction_y);
  for (int c = 0; c < kChannels; ++c) out[c] = 0;
  for (int j = 0; j < Kernel::kTaps; ++j) {
    const float* pixels = frame.ptr<float>(y + Kernel::kFirst + j) + (x + Kernel::kFirst) * kChannels;
    for (int c = 0; c < kChannels; ++c) {
      Real along_x = 0;
      for (int i = 0; i < Kernel::kTaps; ++i) along_x += weights_x[i] * pixels[i * kChannels + c];
      out[c] += weights_y[j] * along_x;
    }
  }
}

template <class Kernel, int kChannels>
void WarpRowWith(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
                 float* out) {
  for (size_t i = 0; i < dx.size(); ++i, out += kChannels) {
    const float whole_x = std::floor(dx[i]), whole_y = std::floor(dy[i]);
    Sample<Kernel, kChannels>(frame, first.x + static_cast<int>(i) + static_cast<int>(whole_x),
                              first.y + static_cast<int>(whole_y), dx[i] - whole_x, dy[i] - whole_y, out);
  }
}

// Calls f<Kernel> of an interpolation.
template <class F>
void WithKernel(Interpolation interpolation, const F& f) {
  switch (interpolation) {
    case Interpolation::kNearest:
      return f.template operator()<Nearest>();
    case Interpolation::kBilinear:
      return f.template operator()<Bilinear>();
    case Interpolation::kBicubic:
      return f.template operator()<CatmullRom>();
  }
}

}  // namespace

void WarpRow(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
             Interpolation interpolation, float* out) {
  if (interpolation == Interpolation::kBicubic) return BicubicRow(frame, first, dx, dy, out);
  WithKernel(interpolation, [&]<class Kernel>() {
    if (frame.channels() == 1)
      WarpRowWith<Kernel, 1>(frame, first, dx, dy, out);
    else
      WarpRowWith<Kernel, 3>(frame, first, dx, dy, out);
  });
}

double WarpDouble(const cv::Mat& frame, double x, double y, int channel, Interpolation interpolation) {
  const double whole_x = std::floor(x), whole_y = std::floor(y);
  double out = 0;
  cv::Mat one_channel;
  cv::extractChannel(frame, one_channel, channel);
  WithKernel(interpolation, [&]<class Kernel>() {
    Sample<Kernel, 1>(one_channel, static_cast<int>(whole_x), static_cast<int>(whole_y), x - whole_x,
                      y - whole_y, &out);
  });
  return out;
}

}  // namespace shimmer::sim
