#include "restore/scene_growth.h"

#include <algorithm>
#include <deque>
#include <limits>

namespace shimmer::restore {
namespace {

constexpr double kMostSamples = 0.8;
constexpr size_t kFewest = 2;

class Growth {
 public:
  Growth(cv::Mat& picture, cv::Mat& known, const std::vector<SceneSample>& samples, double tolerance)
      : picture_(picture),
        known_(known),
        samples_(samples),
        tolerance_(static_cast<float>(tolerance)),
        channels_(picture.channels()),
        waiting_(cv::Mat::zeros(known.size(), CV_8UC1)) {}

  void Run() {
    for (int y = 0; y < known_.rows; ++y)
      for (int x = 0; x < known_.cols; ++x)
        if (known_.at<uint8_t>(y, x) != 0) AskAround({x, y});
    while (!next_.empty()) {
      const cv::Point at = next_.front();
      next_.pop_front();
      waiting_.at<uint8_t>(at) = 0;
      if (!LooksLikeItsNeighbours(at)) continue;
      TakeMedian(at);
      AskAround(at);
    }
  }

 private:
  cv::Rect Around(cv::Point at) const {
    return cv::Rect(at.x - 1, at.y - 1, 3, 3) & cv::Rect({}, known_.size());
  }

  void AskAround(cv::Point at) {
    const cv::Rect around = Around(at);
    for (int y = around.y; y < around.br().y; ++y)
      for (int x = around.x; x < around.br().x; ++x) {
        uint8_t& waiting = waiting_.at<uint8_t>(y, x);
        if (known_.at<uint8_t>(y, x) != 0 || waiting != 0) continue;
        waiting = 1;
        next_.push_back({x, y});
      }
  }

  // Leaves the samples that do in alike_.
  bool LooksLikeItsNeighbours(cv::Point at) {
    float low[kMostChannels], high[kMostChannels];
    std::fill_n(low, channels_, std::numeric_limits<float>::max());
    std::fill_n(high, channels_, std::numeric_limits<float>::lowest());
    const cv::Rect around = Around(at);
    for (int y = around.y; y < around.br().y; ++y)
      for (int x = around.x; x < around.br().x; ++x) {
        if (known_.at<uint8_t>(y, x) == 0) continue;
        const float* level = picture_.ptr<float>(y, x);
        for (int c = 0; c < channels_; ++c)
          low[c] = std::min(low[c], level[c] - tolerance_),
          high[c] = std::max(high[c], level[c] + tolerance_);
      }
    alike_.clear();
    int own = 0;
    for (const SceneSample& sample : samples_) {
      if (sample.own.at<uint8_t>(at) == 0) continue;
      ++own;
      const float* level = sample.frame.ptr<float>(at.y, at.x);
      bool within = true;
      for (int c = 0; c < channels_; ++c) within = within && low[c] <= level[c] && level[c] <= high[c];
      if (within) alike_.push_back(level);
    }
    return alike_.size() >= kFewest && static_cast<double>(alike_.size()) >= kMostSamples * own;
  }

  void TakeMedian(cv::Point at) {
    for (int c = 0; c < channels_; ++c) {
      const auto middle = alike_.begin() + static_cast<std::ptrdiff_t>(alike_.size() / 2);
      std::ranges::nth_element(alike_, middle, {}, [&](const float* level) { return level[c]; });
      picture_.ptr<float>(at.y, at.x)[c] = (*middle)[c];
    }
    known_.at<uint8_t>(at) = 255;
  }

  static constexpr int kMostChannels = 3;
  cv::Mat& picture_;
  cv::Mat& known_;
  const std::vector<SceneSample>& samples_;
  float tolerance_;
  int channels_;
  cv::Mat waiting_;                  // whether it is in next_
  std::deque<cv::Point> next_;       // may have become alike to what is known beside them
  std::vector<const float*> alike_;  // levels of the samples
};

}  // namespace

void GrowScene(cv::Mat& picture, cv::Mat& known, const std::vector<SceneSample>& samples, double tolerance) {
  Growth(picture, known, samples, tolerance).Run();
}

}  // namespace shimmer::restore
