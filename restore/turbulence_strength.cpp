#include "restore/turbulence_strength.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "restore/detail_level.h"
#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 16;
constexpr double kSmooth_px = 1;      // of the reduced frame: against noise
constexpr int kSquare_px = 16;        // of the reduced frame
constexpr double kFlatShare = 0.1;    // of the px, which tell the noise
constexpr double kLeastGradient = 1;  // levels a px, root mean square: below it a square tells nothing
constexpr double kMostOfMedian = 6;

// Squared gradients by central differences, CV_64FC1.
cv::Mat SquaredGradient(const cv::Mat& grey) {
  cv::Mat along_x, along_y;
  const cv::Mat kernel = (cv::Mat_<double>(1, 3) << -0.5, 0, 0.5);
  cv::filter2D(grey, along_x, CV_64F, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
  cv::filter2D(grey, along_y, CV_64F, kernel.t(), {-1, -1}, 0, cv::BORDER_REPLICATE);
  return along_x.mul(along_x) + along_y.mul(along_y);
}

// Of white noise of variance 1 that was smoothed: its squared gradient over its variance. The correlation of
// such noise at a distance of 2 px is exp(-1 / s^2).
double NoiseGradient() { return 1 - std::exp(-1 / (kSmooth_px * kSmooth_px)); }

struct Square {
  double deviation = 0, gradient = 0, mean_gradient = 0, px = 0;  // sums

  Square& operator+=(const Square& other) {
    deviation += other.deviation, gradient += other.gradient, mean_gradient += other.mean_gradient;
    px += other.px;
    return *this;
  }
  double TiltVariance() const {
    const double high = gradient, low = std::clamp(mean_gradient, 1e-12 * high, high);
    // (the mean of both is theirs to second order)
    const double mean = high - low < 1e-4 * high ? (high + low) / 2 : (high - low) / std::log(high / low);
    return std::max(0.0, deviation / mean);
  }
  bool HasTexture() const { return px > 0 && gradient / px >= kLeastGradient * kLeastGradient; }
};

// The px's sums less what noise adds to them.
Square Less(Square sums, double noise, double frames) {
  sums.deviation -= noise * sums.px;
  sums.gradient -= noise * NoiseGradient() * sums.px;
  sums.mean_gradient -= noise * NoiseGradient() * sums.px / frames;
  sums.gradient = std::max(sums.gradient, 0.0);
  return sums;
}

// The value below which half of the weight is.
double WeightedMedian(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double all = 0, so_far = 0;
  for (const auto& [value, weight] : values) all += weight;
  for (const auto& [value, weight] : values)
    if ((so_far += weight) >= all / 2) return value;
  return 0;
}

}  // namespace

double TiltConstant(Tilt tilt) { return tilt == Tilt::kEdge ? 2.914 : tilt == Tilt::kGrad ? 2.838 : 3.041; }

double Cn2Of(double tilt_variance_px2, const Optics& optics) {
  if (!(optics.pixel_rad > 0 && optics.aperture_m > 0 && optics.distance_m > 0))
    throw std::invalid_argument("optics: field of view of a px, aperture and distance must be above 0");
  const double constant = TiltConstant(optics.tilt) * (optics.point_source ? 3 / 8.0 : 1);
  return optics.pixel_rad * optics.pixel_rad * std::cbrt(optics.aperture_m) / (optics.distance_m * constant) *
         tilt_variance_px2;
}

void StrengthEstimate::Add(const cv::Mat& frame, const cv::Mat& moving) {
  RequireFrame(frame, "frame");
  if (std::min(frame.cols, frame.rows) < kLeastSide_px)
    throw std::invalid_argument("frame: must be at least 16x16 px");
  if (!moving.empty() && (moving.type() != CV_8UC1 || moving.size() != frame.size()))
    throw std::invalid_argument("moving: must be CV_8UC1 and of the frame's size");
  const int scale = LevelScalesOf(frame.size()).fine;
  cv::Mat grey = ReducedGrey(frame, scale);
  grey.convertTo(grey, CV_64F, 255 / WhiteOf(frame.depth()));
  if (count_.empty()) {
    size_ = frame.size(), type_ = frame.type();
    for (cv::Mat* sum : {&count_, &mean_, &deviation_, &gradient_})
      *sum = cv::Mat::zeros(grey.size(), CV_64FC1);
  }
  if (frame.size() != size_ || frame.type() != type_)
    throw std::invalid_argument("frame: is of another size or type than the first");
  cv::Mat still = cv::Mat::ones(grey.size(), CV_8UC1);
  if (!moving.empty()) {
    cv::Mat share;
    cv::resize(moving({0, 0, grey.cols * scale, grey.rows * scale}), share, grey.size(), 0, 0,
               cv::INTER_AREA);
    // With what smoothing and gradients mix in of it.
    cv::dilate(share, share, {}, {-1, -1}, 3);
    still = share == 0;
  }
  cv::GaussianBlur(grey, grey, {0, 0}, kSmooth_px, 0, cv::BORDER_REFLECT_101);
  const cv::Mat gradient = SquaredGradient(grey);
  for (int y = 0; y < grey.rows; ++y) {
    const auto* value = grey.ptr<double>(y);
    const auto* slope = gradient.ptr<double>(y);
    const auto* counts = still.ptr<uint8_t>(y);
    auto *count = count_.ptr<double>(y), *mean = mean_.ptr<double>(y), *deviation = deviation_.ptr<double>(y),
         *sum = gradient_.ptr<double>(y);
    for (int x = 0; x < grey.cols; ++x) {
      if (counts[x] == 0) continue;
      const double off = value[x] - mean[x];
      mean[x] += off / ++count[x];
      deviation[x] += off * (value[x] - mean[x]);
      sum[x] += slope[x];
    }
  }
}

TurbulenceStrength StrengthEstimate::Result() const {
  TurbulenceStrength result;
  if (count_.empty()) return result;
  const int scale = LevelScalesOf(size_).fine;
  result.square_px = kSquare_px * scale;
  double frames = 0;
  cv::minMaxLoc(count_, nullptr, &frames);
  const cv::Size squares((count_.cols + kSquare_px - 1) / kSquare_px,
                         (count_.rows + kSquare_px - 1) / kSquare_px);
  result.map = cv::Mat(squares, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  if (frames < 2) return result;

  // By px; those that were seen in fewer than half of the frames have neighbours of other times.
  const cv::Mat of_mean = SquaredGradient(mean_);
  const auto px = [&](int y, int x) {
    const double count = count_.at<double>(y, x);
    if (count < 2 || count < frames / 2) return Square{};
    return Square{deviation_.at<double>(y, x) / (count - 1), gradient_.at<double>(y, x) / count,
                  of_mean.at<double>(y, x), 1};
  };
  std::vector<Square> by_gradient;
  for (int y = 0; y < count_.rows; ++y)
    for (int x = 0; x < count_.cols; ++x)
      if (const Square at = px(y, x); at.px > 0) by_gradient.push_back(at);
  if (by_gradient.empty()) return result;
  std::sort(by_gradient.begin(), by_gradient.end(),
            [](const Square& a, const Square& b) { return a.gradient < b.gradient; });
  // Noise, from the px of the least and those of the most texture: sigma^2 = noise + v * gradient of both.
  const size_t few =
      std::max<size_t>(1, static_cast<size_t>(kFlatShare * static_cast<double>(by_gradient.size())));
  Square flat, rich;
  for (size_t i = 0; i < few; ++i) flat += by_gradient[i], rich += by_gradient[by_gradient.size() - 1 - i];
  double noise = flat.deviation / flat.px;
  if (flat.gradient < rich.gradient) {
    const double slope = (rich.deviation - flat.deviation) / (rich.gradient - flat.gradient);
    noise -= std::max(0.0, slope) * flat.gradient / flat.px;
  }
  noise = std::max(noise, 0.0);
  result.noise_levels = std::sqrt(noise);

  std::vector<Square> rich_squares;
  std::vector<std::pair<double, double>> weighed;
  const double to_px = static_cast<double>(scale) * scale;
  for (int i = 0; i < squares.height; ++i)
    for (int j = 0; j < squares.width; ++j) {
      Square square;
      for (int y = i * kSquare_px; y < std::min((i + 1) * kSquare_px, count_.rows); ++y)
        for (int x = j * kSquare_px; x < std::min((j + 1) * kSquare_px, count_.cols); ++x) square += px(y, x);
      square = Less(square, noise, frames);
      if (!square.HasTexture()) continue;
      rich_squares.push_back(square);
      weighed.emplace_back(square.TiltVariance(), square.gradient);
      result.map.at<float>(i, j) = static_cast<float>(to_px * square.TiltVariance());
    }
  result.texture = static_cast<double>(rich_squares.size()) / static_cast<double>(squares.area());
  const double most = kMostOfMedian * WeightedMedian(weighed);
  Square all;
  for (const Square& square : rich_squares)
    if (square.TiltVariance() <= most) all += square;
  if (all.px > 0) result.tilt_variance_px2 = to_px * all.TiltVariance();
  return result;
}

}  // namespace shimmer::restore
