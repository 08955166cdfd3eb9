#include "restore/baselines.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <deque>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

struct Weighed {
  cv::Mat frame;   // CV_32F of its channels, in levels
  cv::Mat weight;  // CV_32FC1; of kLucky
};

cv::Mat LuckOf(const cv::Mat& levels) {
  cv::Mat grey = levels, edges, weight;
  if (levels.channels() == 3) cv::cvtColor(levels, grey, cv::COLOR_RGB2GRAY);
  cv::Laplacian(grey, edges, CV_32F);
  cv::GaussianBlur(edges.mul(edges), weight, {}, kLuckySigma_px);
  cv::pow(weight, kLuckyPower, weight);
  return weight + 1e-6f;  // where nothing has any detail all count the same
}

Weighed WeighedOf(const cv::Mat& frame, Baseline baseline) {
  Weighed weighed;
  frame.convertTo(weighed.frame, CV_32F, 255 / WhiteOf(frame.depth()));
  if (baseline == Baseline::kLucky) weighed.weight = LuckOf(weighed.frame);
  return weighed;
}

void MeanOfRow(const std::deque<Weighed>& window, int y, float* mean) {
  const cv::Mat& first = window.front().frame;
  const int channels = first.channels();
  for (int x = 0; x < first.cols; ++x) {
    double sums[3] = {}, weights = 0;
    for (const Weighed& weighed : window) {
      const double weight = weighed.weight.empty() ? 1 : weighed.weight.at<float>(y, x);
      weights += weight;
      for (int c = 0; c < channels; ++c) sums[c] += weight * weighed.frame.ptr<float>(y)[x * channels + c];
    }
    for (int c = 0; c < channels; ++c) mean[x * channels + c] = static_cast<float>(sums[c] / weights);
  }
}

void MedianOfRow(const std::deque<Weighed>& window, int y, float* median) {
  const cv::Mat& first = window.front().frame;
  std::vector<float> samples(window.size());
  const size_t half = samples.size() / 2;
  for (int i = 0; i < first.cols * first.channels(); ++i) {
    for (size_t k = 0; k < window.size(); ++k) samples[k] = window[k].frame.ptr<float>(y)[i];
    std::ranges::nth_element(samples, samples.begin() + static_cast<ptrdiff_t>(half));
    median[i] = samples[half];
    if (samples.size() % 2 == 0)
      median[i] =
          (median[i] + *std::max_element(samples.begin(), samples.begin() + static_cast<ptrdiff_t>(half))) /
          2;
  }
}

cv::Mat Fused(const std::deque<Weighed>& window, Baseline baseline) {
  cv::Mat fused(window.front().frame.size(), window.front().frame.type());
  tbb::parallel_for(0, fused.rows, [&](int y) {
    auto* row = fused.ptr<float>(y);
    baseline == Baseline::kMedian ? MedianOfRow(window, y, row) : MeanOfRow(window, y, row);
  });
  return fused;
}

cv::Mat Sharpened(const cv::Mat& levels) {
  cv::Mat soft;
  cv::GaussianBlur(levels, soft, {}, kUnsharpSigma_px);
  return levels + kUnsharpAmount * (levels - soft);
}

}  // namespace

void RestoreSimply(Baseline baseline, Frames& video, const std::function<void(const cv::Mat&)>& sink) {
  const int64_t count = video.count(), most = baseline == Baseline::kSharpen ? 1 : kBaselineFrames;
  int type = -1;
  cv::Size size;
  std::deque<Weighed> window;
  cv::Mat result;
  int64_t read = 0;
  for (int64_t k = 0; k < count; ++k) {
    const int64_t first = std::clamp<int64_t>(k - most / 2, 0, std::max<int64_t>(count - most, 0));
    const int64_t end = std::min(first + most, count);
    const bool changes = read < end;
    for (; read < end; ++read) {
      const cv::Mat frame = video.Read(read);
      RequireFrame(frame, "frame");
      if (type < 0) type = frame.type(), size = frame.size();
      if (frame.type() != type || frame.size() != size)
        throw std::invalid_argument("frame " + std::to_string(read) +
                                    " is of another size or type than the first");
      window.push_back(WeighedOf(frame, baseline));
      if (std::ssize(window) > most) window.pop_front();
    }
    if (changes) {
      const cv::Mat levels =
          baseline == Baseline::kSharpen ? Sharpened(window.front().frame) : Fused(window, baseline);
      levels.convertTo(result, CV_MAT_DEPTH(type), WhiteOf(CV_MAT_DEPTH(type)) / 255);
    }
    sink(result.clone());
  }
}

}  // namespace shimmer::restore
