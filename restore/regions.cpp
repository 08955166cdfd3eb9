#include "restore/regions.h"

#include <tbb/parallel_for.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

struct Sum {
  double sum = 0;
  int64_t samples = 0;
};

Sum SumIn(const cv::Mat& region, cv::Range rows, const cv::Mat& values) {
  const int channels = values.cols / region.cols;
  Sum sum;
  for (int y = rows.start; y < rows.end; ++y) {
    const auto* in = region.ptr<uint8_t>(y);
    const auto* row = values.ptr<double>(y - rows.start);
    for (int x = 0; x < region.cols; ++x) {
      if (!in[x]) continue;
      for (int c = 0; c < channels; ++c) sum.sum += row[x * channels + c];
      sum.samples += channels;
    }
  }
  return sum;
}

}  // namespace

std::vector<std::optional<double>> MeansIn(cv::Size frame, std::span<const cv::Mat> regions,
                                           const std::function<cv::Mat(cv::Range rows)>& values) {
  for (const cv::Mat& region : regions)
    if (region.size() != frame || region.type() != CV_8UC1)
      throw std::invalid_argument("region is " + SizeText(region.size()) + " px of " +
                                  cv::typeToString(region.type()) + ", must be " + SizeText(frame) +
                                  " of CV_8UC1");
  const int parts = (frame.height + kRowsAtOnce - 1) / kRowsAtOnce;
  std::vector<std::vector<Sum>> sums(parts);
  tbb::parallel_for(0, parts, [&](int part) {
    const cv::Range rows(part * kRowsAtOnce, std::min((part + 1) * kRowsAtOnce, frame.height));
    const cv::Mat of_rows = values(rows);
    for (const cv::Mat& region : regions) sums[part].push_back(SumIn(region, rows, of_rows));
  });
  std::vector<std::optional<double>> means(regions.size());
  for (size_t i = 0; i < regions.size(); ++i) {
    Sum all;
    for (const std::vector<Sum>& part : sums) all.sum += part[i].sum, all.samples += part[i].samples;
    if (all.samples > 0) means[i] = all.sum / static_cast<double>(all.samples);
  }
  return means;
}

cv::Mat BoxAround(const cv::Mat& region) {
  cv::Mat box = cv::Mat::zeros(region.size(), CV_8UC1);
  box(cv::boundingRect(region)).setTo(255);
  return box;
}

}  // namespace shimmer::restore
