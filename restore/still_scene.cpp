#include "restore/still_scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/levels.h"
#include "restore/mask_cleaning.h"
#include "restore/otsu.h"

namespace shimmer::restore {
namespace {

constexpr int kRadius_px = 1;
constexpr double kSmooth_px = 1.5;
constexpr int kMostLevels = 256, kBins = 2048;
constexpr double kAgreeing = 1.0 / 3, kCalmest = 1.0 / 3;
constexpr int kGuard_px = 3;  // around what is outside of the scene: its blurred rim
constexpr double kSteepest = 0.1, kLeastSlope = 2, kMostTilt_px = 8;  // levels a px
constexpr double kSurely = 3;                                         // standard deviations of the tilt
constexpr int kMostWide_px = 8;
constexpr int kFewest = 2;  // samples that a pixel's median is taken of; of calm ones one more
// The threshold is Otsu's, divided as the paper's authors do, but no less than so many standard deviations of
// the pixels around the scene, nor than so many levels.
constexpr double kDivisor = 1.5, kNoiseFactor = 4, kLeastThreshold = 6;

struct Medians {
  cv::Mat picture, known;  // known: CV_8UC1, 255 or 0
};
// pick(y, x, chosen) names the samples whose median is taken; none: the pixel stays unknown.
Medians MediansOf(const std::vector<SceneSample>& samples,
                  const std::function<void(int, int, std::vector<int>&)>& pick) {
  const cv::Mat& first = samples.front().frame;
  const int channels = first.channels();
  Medians result{cv::Mat::zeros(first.size(), first.type()), cv::Mat::zeros(first.size(), CV_8UC1)};
  tbb::parallel_for(0, first.rows, [&](int y) {
    std::vector<int> chosen;
    std::vector<float> values;
    for (int x = 0; x < first.cols; ++x) {
      chosen.clear();
      pick(y, x, chosen);
      if (chosen.empty()) continue;
      result.known.at<uint8_t>(y, x) = 255;
      const auto middle = static_cast<std::ptrdiff_t>(chosen.size() / 2);
      for (int c = 0; c < channels; ++c) {
        values.clear();
        for (const int k : chosen)
          values.push_back(samples[static_cast<size_t>(k)].frame.ptr<float>(y)[x * channels + c]);
        std::nth_element(values.begin(), values.begin() + middle, values.end());
        float median = values[static_cast<size_t>(middle)];
        if (chosen.size() % 2 == 0)
          median = (median + *std::max_element(values.begin(), values.begin() + middle)) / 2;
        result.picture.ptr<float>(y)[x * channels + c] = median;
      }
    }
  });
  return result;
}

// Continued from what is known around, by means over ever larger Gaussians.
void Continue(Medians& scene) {
  const int channels = scene.picture.channels();
  for (double sigma = 2; cv::countNonZero(scene.known) < static_cast<int>(scene.known.total()); sigma *= 2) {
    cv::Mat weight, sum, weights;
    scene.known.convertTo(weight, CV_32F, 1 / 255.0);
    if (cv::countNonZero(scene.known) == 0) return;  // nothing is known anywhere
    cv::merge(std::vector<cv::Mat>(static_cast<size_t>(channels), weight), weights);
    cv::GaussianBlur(scene.picture.mul(weights), sum, {0, 0}, sigma, 0, cv::BORDER_REPLICATE);
    cv::GaussianBlur(weight, weight, {0, 0}, sigma, 0, cv::BORDER_REPLICATE);
    cv::merge(std::vector<cv::Mat>(static_cast<size_t>(channels), cv::max(weight, 1e-6)), weights);
    cv::divide(sum, weights, sum);
    const cv::Mat near = (weight > 0.05) & (scene.known == 0);
    sum.copyTo(scene.picture, near);
    scene.known.setTo(255, near);
    if (sigma > 2.0 * std::max(near.cols, near.rows)) return;
  }
}

std::vector<cv::Mat> DistancesTo(const cv::Mat& picture, const std::vector<SceneSample>& samples) {
  const LocalInterval interval = IntervalOf(picture, kRadius_px);
  std::vector<cv::Mat> distances;
  for (const SceneSample& sample : samples) distances.push_back(DistanceTo(interval, sample.frame));
  return distances;
}

// A pixel that is moved by d changes by d times its gradient: the median over the steepest pixels, as a
// standard deviation. What moves is a small part of all.
double TiltOf(const cv::Mat& picture, const std::vector<SceneSample>& samples) {
  cv::Mat grey, along_x, along_y, steepness;
  cv::extractChannel(picture, grey, 0);
  cv::Sobel(grey, along_x, CV_32F, 1, 0, 3, 1.0 / 8, 0, cv::BORDER_REPLICATE);
  cv::Sobel(grey, along_y, CV_32F, 0, 1, 3, 1.0 / 8, 0, cv::BORDER_REPLICATE);
  cv::magnitude(along_x, along_y, steepness);
  PooledHistogram slopes(kMostLevels, kBins), shifts(kMostTilt_px, kBins);
  slopes.Add(steepness, cv::Mat(steepness.size(), CV_8UC1, cv::Scalar(255)));
  const double steep = std::max(slopes.Quantile(1 - kSteepest), kLeastSlope);
  for (const SceneSample& sample : samples) {
    cv::Mat other;
    cv::extractChannel(sample.frame, other, 0);
    shifts.Add(cv::abs(other - grey) / steepness, (steepness >= steep) & sample.own);
  }
  return shifts.Count() == 0 ? 0 : 1.4826 * shifts.Quantile(0.5);
}

double ThresholdOf(const cv::Mat& picture, const std::vector<SceneSample>& samples,
                   const std::vector<cv::Mat>& distances) {
  PooledHistogram outside(kMostLevels, kBins), residuals(kMostLevels, kBins);
  for (size_t k = 0; k < samples.size(); ++k) {
    outside.Add(distances[k], samples[k].own);
    cv::Mat residual;
    cv::extractChannel(cv::abs(samples[k].frame - picture), residual, 0);
    residuals.Add(residual, samples[k].own);
  }
  const double noise = 1.4826 * residuals.Quantile(0.5);
  return std::max({outside.OtsuThreshold() / kDivisor, kNoiseFactor * noise, kLeastThreshold});
}

}  // namespace

LocalInterval IntervalOf(const cv::Mat& scene, int radius_px) {
  LocalInterval interval;
  const cv::Mat disc = Disc(radius_px);
  cv::erode(scene, interval.low, disc);
  cv::dilate(scene, interval.high, disc);
  return interval;
}

cv::Mat DistanceTo(const LocalInterval& interval, const cv::Mat& frame) {
  const cv::Mat above = frame - interval.high, below = interval.low - frame;
  const cv::Mat outside = cv::max(cv::Mat(cv::max(above, below)), 0);
  cv::Mat smooth;
  cv::GaussianBlur(MostOfChannels(outside), smooth, {0, 0}, kSmooth_px, 0, cv::BORDER_REPLICATE);
  return smooth;
}

StillScene FindStillScene(const std::vector<SceneSample>& samples) {
  if (samples.empty()) throw std::invalid_argument("FindStillScene: there are no samples");
  const int count = static_cast<int>(samples.size());
  const auto at = [&](int k) -> const SceneSample& { return samples[static_cast<size_t>(k)]; };
  const size_t fewest = static_cast<size_t>(std::min(kFewest, count));
  Medians scene = MediansOf(samples, [&](int y, int x, std::vector<int>& chosen) {
    for (int k = 0; k < count; ++k)
      if (at(k).own.at<uint8_t>(y, x) != 0 && at(k).movers.at<uint8_t>(y, x) == 0) chosen.push_back(k);
    if (chosen.size() < fewest) return chosen.clear();
    const size_t calm = std::min(chosen.size(), std::max(fewest + 1, static_cast<size_t>(count * kCalmest)));
    std::ranges::sort(chosen, {}, [&](int k) { return std::pair(at(k).unrest.at<float>(y, x), k); });
    chosen.resize(calm);
  });
  if (cv::countNonZero(scene.known) == 0)  // all of it moves in all samples: what is there most is the scene
    scene = MediansOf(samples, [&](int, int, std::vector<int>& chosen) {
      for (int k = 0; k < count; ++k) chosen.push_back(k);
    });
  Continue(scene);

  std::vector<cv::Mat> distances = DistancesTo(scene.picture, samples);
  double threshold = ThresholdOf(scene.picture, samples, distances);
  cv::Mat agreeing = cv::Mat::zeros(scene.known.size(), CV_32FC1), seen = agreeing.clone();
  for (int k = 0; k < count; ++k) {
    cv::add(agreeing, 1, agreeing, at(k).own & (distances[static_cast<size_t>(k)] <= threshold / 2));
    cv::add(seen, 1, seen, at(k).own);
  }
  cv::erode(agreeing >= kAgreeing * seen, scene.known, Disc(1));
  Continue(scene);

  distances = DistancesTo(scene.picture, samples);
  std::vector<cv::Mat> inside;
  for (int k = 0; k < count; ++k) {
    cv::Mat outside;
    cv::dilate(distances[static_cast<size_t>(k)] > threshold / 2, outside, Disc(kGuard_px));
    inside.push_back(at(k).own & ~outside);
  }
  const Medians better = MediansOf(samples, [&](int y, int x, std::vector<int>& chosen) {
    const auto choose = [&](bool movers) {
      chosen.clear();
      for (int k = 0; k < count; ++k)
        if (inside[static_cast<size_t>(k)].at<uint8_t>(y, x) != 0 &&
            (movers || at(k).movers.at<uint8_t>(y, x) == 0))
          chosen.push_back(k);
      return chosen.size() > fewest;
    };
    if (!choose(false) && !choose(true)) chosen.clear();
  });
  better.picture.copyTo(scene.picture, better.known);
  distances = DistancesTo(scene.picture, samples);
  threshold = ThresholdOf(scene.picture, samples, distances);
  const double tilt = TiltOf(scene.picture, samples);
  const int wide = std::clamp(static_cast<int>(std::ceil(kSurely * tilt)), kRadius_px, kMostWide_px);
  return {IntervalOf(scene.picture, kRadius_px), IntervalOf(scene.picture, wide), tilt, scene.picture,
          threshold};
}

}  // namespace shimmer::restore
