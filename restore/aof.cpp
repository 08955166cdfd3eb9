#include "restore/aof.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "restore/detail_level.h"
#include "restore/levels.h"
#include "restore/otsu.h"

namespace shimmer::restore {
namespace {

constexpr double kAuthorsDivisor = 1.5;
// Of grey's range: a local contrast at which a flow counts half. A step of 8 bits is 1/255.
constexpr double kHalfContrast = 1.0 / 255;
constexpr int kContrastSide_px = 17;  // of the box it is measured in: twice the patches that DIS compares

// In [0, 1): 0 without texture.
cv::Mat Sureness(const cv::Mat& level) {
  const cv::Mat grey = ReducedGrey(level, 1) / WhiteOf(level.depth());
  const cv::Size box(kContrastSide_px, kContrastSide_px);
  cv::Mat mean, square;
  cv::blur(grey, mean, box, {-1, -1}, cv::BORDER_REPLICATE);
  cv::sqrBoxFilter(grey - 0.0, square, CV_32F, box, {-1, -1}, true, cv::BORDER_REPLICATE);
  cv::Mat variance = cv::max(square - mean.mul(mean), 0);
  cv::Mat sure;
  cv::divide(variance, variance + kHalfContrast * kHalfContrast, sure);
  return sure;
}

// The line through displacements over time that fits them best, pixel by pixel.
class Line {
 public:
  explicit Line(cv::Size size)
      : count_(size, CV_32FC1, cv::Scalar(1)),  // the frame itself, at 0
        time_(cv::Mat::zeros(size, CV_32FC1)),
        time2_(time_.clone()) {
    for (Axis& axis : axes_) axis = {time_.clone(), time_.clone()};
  }

  // weight: CV_32FC1, 0 where it is not to be used.
  void Add(int time, const std::vector<cv::Mat>& displacement, const cv::Mat& weight) {
    count_ += weight;
    time_ += weight * time;
    time2_ += weight * (time * time);
    for (size_t i = 0; i < 2; ++i) {
      const cv::Mat weighted = displacement[i].mul(weight);
      axes_[i].sum += weighted;
      axes_[i].with_time += weighted * time;
    }
  }

  cv::Mat Speed() const {
    const cv::Mat spread = cv::max(count_.mul(time2_) - time_.mul(time_), 1);  // 0: without a neighbour
    const auto slope = [&](const Axis& axis) {
      return cv::Mat((count_.mul(axis.with_time) - time_.mul(axis.sum)) / spread);
    };
    cv::Mat speed;
    cv::magnitude(slope(axes_[0]), slope(axes_[1]), speed);
    return speed;
  }

 private:
  struct Axis {
    cv::Mat sum, with_time;
  };
  cv::Mat count_, time_, time2_;
  Axis axes_[2];
};

}  // namespace

cv::Mat OwnAtSize(const cv::Mat& own, cv::Size size) {
  cv::Mat resized;
  cv::resize(own, resized, size, 0, 0, cv::INTER_NEAREST);
  return resized;
}

Place PlaceAt(int64_t k, const std::function<const SteadyFrame*(int64_t)>& frame_at) {
  Place place{*frame_at(k), {}};
  for (int n = 0; n < kMostNeighbours; ++n) {
    const SteadyFrame* neighbour = frame_at(k + NeighbourAt(n));
    place.neighbours.push_back(neighbour ? *neighbour : SteadyFrame());
  }
  return place;
}

Place PlaceAt(int64_t k, const std::vector<SteadyFrame>& frames) {
  return PlaceAt(k, [&](int64_t i) {
    return i >= 0 && i < std::ssize(frames) ? &frames[static_cast<size_t>(i)] : nullptr;
  });
}

int NeighbourAt(int n) { return (n % 2 == 0 ? -2 : 2) << (n / 2); }

double MeanDistance(int neighbours) {
  double sum = 0;
  for (int n = 0; n < neighbours; ++n) sum += std::abs(NeighbourAt(n));
  return sum / neighbours;
}

std::vector<cv::Mat> AofOf(DenseFlow& flow, const Place& place, int most_neighbours) {
  return MotionOf(flow, place, most_neighbours).aof;
}

Motion MotionOf(DenseFlow& flow, const Place& place, int most_neighbours) {
  const cv::Mat frame = HalvedIfLarge(place.current.frame), own = OwnAtSize(place.current.own, frame.size());
  const cv::Mat sure = Sureness(frame);
  std::vector<cv::Mat> others;
  for (int n = 0; n < most_neighbours; ++n)
    if (const cv::Mat& other = place.neighbours[static_cast<size_t>(n)].frame; !other.empty())
      others.push_back(HalvedIfLarge(other));
  const std::vector<cv::Mat> flows = flow.Flows(frame, others);
  auto next = flows.begin();
  Motion motion;
  const auto finish = [&](cv::Mat mean) {
    mean = mean.mul(sure);
    mean.setTo(0, own == 0);
    return mean;
  };
  cv::Mat sum = cv::Mat::zeros(frame.size(), CV_32FC1), weights = sum.clone();
  Line line(frame.size());
  for (int n = 0; n < most_neighbours; ++n) {
    const SteadyFrame& neighbour = place.neighbours[static_cast<size_t>(n)];
    if (!neighbour.frame.empty()) {
      std::vector<cv::Mat> axes;
      cv::split(*next++, axes);
      cv::Mat length, weight;
      cv::magnitude(axes[0], axes[1], length);
      OwnAtSize(neighbour.own, frame.size()).convertTo(weight, CV_32F, 1 / 255.0);
      sum += length.mul(weight), weights += weight;
      line.Add(NeighbourAt(n), axes, weight);
    }
    if (n % 2 == 1) motion.aof.push_back(finish(cv::Mat(sum / cv::max(weights, 1))));
  }
  motion.speed = finish(line.Speed());
  return motion;
}

double Clearness(const cv::Mat& aof, const cv::Mat& use) {
  double most = 0;
  cv::minMaxLoc(aof, nullptr, &most, nullptr, nullptr, use);
  if (!(most > 0)) return 0;
  return cv::mean(cv::abs(aof / most - 0.5), use)[0];
}

void AofChoice::Add(const std::vector<cv::Mat>& aof, const cv::Mat& own) {
  Seen seen{{}, own};
  // Halves of 16 bits are exact enough: 1/2,048 of the flow.
  for (const cv::Mat& map : aof) map.convertTo(seen.aof.emplace_back(), CV_16F);
  seen_.push_back(seen);
}

AofSettings AofChoice::Settings() const {
  AofSettings settings;
  double best = -1, most = 0;
  const auto map = [&](const Seen& seen, int n) {
    cv::Mat aof;
    seen.aof[static_cast<size_t>(n)].convertTo(aof, CV_32F);
    return aof;
  };
  for (int n = 0; 2 * n < kMostNeighbours; ++n) {
    double clearness = 0, largest = 0;
    for (const Seen& seen : seen_) {
      const cv::Mat aof = map(seen, n);
      clearness += Clearness(aof, seen.own);
      double most_here = 0;
      cv::minMaxLoc(aof, nullptr, &most_here);
      largest = std::max(largest, most_here);
    }
    if (clearness > best) best = clearness, settings.neighbours = 2 * (n + 1), most = largest;
  }
  if (!(most > 0)) return settings;
  PooledHistogram pooled(most);
  for (const Seen& seen : seen_) pooled.Add(map(seen, settings.neighbours / 2 - 1), seen.own);
  settings.threshold_px = pooled.OtsuThreshold() / kAuthorsDivisor;
  settings.typical_px = pooled.Quantile(0.5);
  return settings;
}

}  // namespace shimmer::restore
