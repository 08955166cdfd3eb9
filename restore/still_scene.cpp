#include "restore/still_scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/mask_cleaning.h"
#include "restore/scene_growth.h"
#include "restore/scene_threshold.h"

namespace shimmer::restore {
namespace {

constexpr int kRadius_px = 1;
constexpr double kAgreeing = 1.0 / 3, kCalmest = 1.0 / 3;
constexpr double kInside = 0.5;  // of the pooled threshold: what is nearer to the scene is of it
constexpr double kAlike = 0.25;  // of it: how far the scene is from its neighbours where nothing is between
constexpr int kGuard_px = 3;     // around what is outside of the scene: its blurred rim
constexpr double kSurely = 3;    // standard deviations of the tilt
constexpr int kMostWide_px = 8;
// Samples that a pixel's median is taken of, also as a part of all; of calm ones one more. A pixel that is
// seen by fewer was never seen for sure: the rims of what hides it are not.
constexpr int kFewest = 2;
constexpr double kFewestPart = 0.1;
// Of the pooled threshold: the least where the scene was seen, and where it is but a guess.
constexpr double kSeenPart = 0.6, kGuessedPart = 1;

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

// What a picture of the still scene says of the samples.
struct Judgement {
  StillScene scene;
  double pooled;                   // PooledThreshold
  std::vector<cv::Mat> distances;  // of the samples, to its interval
};
Judgement JudgementOf(const cv::Mat& picture, const std::vector<SceneSample>& samples, const cv::Mat& known) {
  Judgement judgement;
  StillScene& scene = judgement.scene;
  scene.picture = picture.clone();
  scene.tilt_px = TiltOf(picture, samples);
  scene.interval = IntervalOf(picture, kRadius_px);
  scene.wide = IntervalOf(
      picture, std::clamp(static_cast<int>(std::ceil(kSurely * scene.tilt_px)), kRadius_px, kMostWide_px));
  for (const SceneSample& sample : samples)
    judgement.distances.push_back(DistanceTo(scene.interval, sample.frame));
  judgement.pooled = PooledThreshold(picture, samples, judgement.distances);
  scene.threshold = ThresholdsByExcess(ExcessOf(scene.interval, scene.wide), samples, judgement.distances,
                                       known, kSeenPart * judgement.pooled);
  cv::Mat(cv::max(scene.threshold, kGuessedPart * judgement.pooled)).copyTo(scene.threshold, ~known);
  return judgement;
}

// The part of the samples' own px that show the scene in each pixel is large enough.
cv::Mat AgreedUpon(const Judgement& judgement, const std::vector<SceneSample>& samples) {
  cv::Mat agreeing = cv::Mat::zeros(samples[0].own.size(), CV_32FC1), seen = agreeing.clone(), agreed;
  for (size_t k = 0; k < samples.size(); ++k) {
    cv::add(agreeing, 1, agreeing, samples[k].own & (judgement.distances[k] <= kInside * judgement.pooled));
    cv::add(seen, 1, seen, samples[k].own);
  }
  cv::erode(agreeing >= kAgreeing * seen, agreed, Disc(1));
  return agreed;
}

}  // namespace

StillScene FindStillScene(const std::vector<SceneSample>& samples, const cv::Mat& passing) {
  if (samples.empty()) throw std::invalid_argument("FindStillScene: there are no samples");
  const int count = static_cast<int>(samples.size());
  const auto at = [&](int k) -> const SceneSample& { return samples[static_cast<size_t>(k)]; };
  const size_t fewest =
      static_cast<size_t>(std::max(std::min(kFewest, count), static_cast<int>(kFewestPart * count)));
  Medians scene = MediansOf(samples, [&](int y, int x, std::vector<int>& chosen) {
    const auto choose = [&](bool movers) {
      chosen.clear();
      for (int k = 0; k < count; ++k)
        if (at(k).own.at<uint8_t>(y, x) != 0 && (movers || at(k).movers.at<uint8_t>(y, x) == 0))
          chosen.push_back(k);
      return chosen.size() >= fewest;
    };
    const bool passes = !passing.empty() && passing.at<uint8_t>(y, x) != 0;
    if (!choose(false) && !(passes && choose(true))) return chosen.clear();
    const size_t calm = std::min(chosen.size(), std::max(fewest + 1, static_cast<size_t>(count * kCalmest)));
    std::ranges::sort(chosen, {}, [&](int k) { return std::pair(at(k).unrest.at<float>(y, x), k); });
    chosen.resize(calm);
  });
  if (cv::countNonZero(scene.known) == 0)  // all of it moves in all samples: what is there most is the scene
    scene = MediansOf(samples, [&](int, int, std::vector<int>& chosen) {
      for (int k = 0; k < count; ++k) chosen.push_back(k);
    });
  cv::Mat known = scene.known.clone();
  Continue(scene);

  const Judgement first = JudgementOf(scene.picture, samples, known);
  known &= AgreedUpon(first, samples);
  GrowScene(scene.picture, known, samples, kAlike * first.pooled);
  scene.known = known.clone();
  Continue(scene);

  const Judgement judgement = JudgementOf(scene.picture, samples, known);
  std::vector<cv::Mat> inside;
  for (size_t k = 0; k < samples.size(); ++k) {
    cv::Mat outside;
    cv::dilate(judgement.distances[k] > kInside * judgement.pooled, outside, Disc(kGuard_px));
    inside.push_back(samples[k].own & ~outside);
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
  return JudgementOf(scene.picture, samples, known).scene;
}

}  // namespace shimmer::restore
