#include "restore/scene_threshold.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "restore/otsu.h"

namespace shimmer::restore {
namespace {

constexpr int kMostLevels = 256, kBins = 2048;
constexpr double kSteepest = 0.1, kLeastSlope = 2, kMostTilt_px = 8;  // levels a px
constexpr double kToDeviation = 1.4826;                               // of a normal distribution's median
// No threshold is less than so many standard deviations of the pixels around the scene, nor than so many
// levels.
constexpr double kAuthorsDivisor = 1.5, kNoiseFactor = 4, kLeast = 6;
// Classes of excess, by its root: 0, 1, 4, 9 ... 256 levels.
constexpr int kClasses = 17;
constexpr double kMostOfClass = 0.95, kBeyondMost = 2;

double NoiseThreshold(const cv::Mat& picture, const std::vector<SceneSample>& samples) {
  PooledHistogram residuals(kMostLevels, kBins);
  for (const SceneSample& sample : samples) {
    cv::Mat residual;
    cv::extractChannel(cv::abs(sample.frame - picture), residual, 0);
    residuals.Add(residual, sample.own);
  }
  return std::max(kNoiseFactor * kToDeviation * residuals.Quantile(0.5), kLeast);
}

}  // namespace

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
  return shifts.Count() == 0 ? 0 : kToDeviation * shifts.Quantile(0.5);
}

double PooledThreshold(const cv::Mat& picture, const std::vector<SceneSample>& samples,
                       const std::vector<cv::Mat>& distances) {
  PooledHistogram outside(kMostLevels, kBins);
  for (size_t k = 0; k < samples.size(); ++k) outside.Add(distances[k], samples[k].own);
  return std::max(outside.OtsuThreshold() / kAuthorsDivisor, NoiseThreshold(picture, samples));
}

cv::Mat ThresholdsByExcess(const cv::Mat& excess, const std::vector<SceneSample>& samples,
                           const std::vector<cv::Mat>& distances, const cv::Mat& known, double least) {
  cv::Mat root;
  cv::sqrt(excess, root);
  std::vector<PooledHistogram> classes(kClasses, PooledHistogram(kMostLevels, kBins));
  for (int c = 0; c < kClasses; ++c) {
    const cv::Mat alike = (root >= c - 0.5) & (root < c + 0.5) & known;
    if (cv::countNonZero(alike) == 0) continue;
    for (size_t k = 0; k < samples.size(); ++k)
      classes[static_cast<size_t>(c)].Add(distances[k], alike & samples[k].own & (samples[k].movers == 0));
  }
  cv::Mat thresholds(1, kClasses, CV_32FC1), by_pixel;
  for (int c = 0; c < kClasses; ++c)
    thresholds.at<float>(c) = static_cast<float>(
        std::max(least, kBeyondMost * classes[static_cast<size_t>(c)].Quantile(kMostOfClass)));
  cv::remap(thresholds, by_pixel, root, cv::Mat::zeros(root.size(), CV_32FC1), cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
  return by_pixel;
}

}  // namespace shimmer::restore
