#include "restore/ssim.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr double kC1 = 2.55 * 2.55, kC2 = 7.65 * 7.65;

// Where and how local means are taken.
struct Window {
  int radius_px;
  double sigma_px;  // of the Gaussian; 0: flat
  int border;       // OpenCV's name for what lies beyond the frame
  int cropped_px;   // how much of the result on each side does not count
  double variance_factor = 1;
};

constexpr Window kOpenCv{.radius_px = 5, .sigma_px = 1.5, .border = cv::BORDER_REFLECT_101, .cropped_px = 0};
constexpr Window kRestormer{.radius_px = 5, .sigma_px = 1.5, .border = cv::BORDER_REPLICATE, .cropped_px = 0};
constexpr Window kScikitImage{.radius_px = 3,
                              .sigma_px = 0,
                              .border = cv::BORDER_REFLECT,
                              .cropped_px = 3,
                              .variance_factor = 49.0 / 48};

cv::Mat LocalMean(const cv::Mat& values, const Window& window) {
  const int side = 2 * window.radius_px + 1;
  cv::Mat mean;
  if (window.sigma_px > 0) {
    const cv::Mat kernel = cv::getGaussianKernel(side, window.sigma_px, CV_64F);
    cv::sepFilter2D(values, mean, CV_64F, kernel, kernel, {-1, -1}, 0, window.border);
  } else {
    cv::boxFilter(values, mean, CV_64F, {side, side}, {-1, -1}, true, window.border);
  }
  return mean;
}

// Of the index of samples [first, end) in each of these rows.
double SumOfSimilarity(const cv::Mat& a, const cv::Mat& b, const Window& window, cv::Range rows, int first,
                       int end) {
  const cv::Mat mean_a = LocalMean(a, window), mean_b = LocalMean(b, window);
  const cv::Mat square_a = LocalMean(a.mul(a), window), square_b = LocalMean(b.mul(b), window),
                product = LocalMean(a.mul(b), window);
  double sum = 0;
  for (int y = rows.start; y < rows.end; ++y)
    for (int i = first; i < end; ++i) {
      const double ma = mean_a.ptr<double>(y)[i], mb = mean_b.ptr<double>(y)[i];
      const double variances = square_a.ptr<double>(y)[i] - ma * ma + (square_b.ptr<double>(y)[i] - mb * mb);
      const double covariance = product.ptr<double>(y)[i] - ma * mb;
      sum += (2 * ma * mb + kC1) * (2 * window.variance_factor * covariance + kC2) /
             ((ma * ma + mb * mb + kC1) * (window.variance_factor * variances + kC2));
    }
  return sum;
}

template <class LevelsOf>
double MeanSimilarity(const cv::Mat& a, const cv::Mat& b, const Window& window, const LevelsOf& levels_of) {
  const int channels = RequireFramePair(a, b), cropped = window.cropped_px;
  double sum = 0, counted = 0;
  ForRows(a.rows - 2 * cropped, [&](cv::Range counting) {
    const cv::Range rows(counting.start + cropped, counting.end + cropped);
    // What their windows see; at the frame's border OpenCV adds what lies beyond.
    const cv::Range seen(std::max(rows.start - window.radius_px, 0),
                         std::min(rows.end + window.radius_px, a.rows));
    const cv::Mat levels_a = levels_of(a, seen, channels), levels_b = levels_of(b, seen, channels);
    const int used = levels_a.channels();  // Y is one
    sum += SumOfSimilarity(levels_a, levels_b, window, {rows.start - seen.start, rows.end - seen.start},
                           cropped * used, (a.cols - cropped) * used);
    counted += static_cast<double>(rows.size()) * (a.cols - 2 * cropped) * used;
  });
  return sum / counted;
}

}  // namespace

double SsimOpenCv(const cv::Mat& a, const cv::Mat& b) { return MeanSimilarity(a, b, kOpenCv, Levels); }

std::optional<double> SsimScikitImage(const cv::Mat& a, const cv::Mat& b) {
  RequireFramePair(a, b);
  if (std::min(a.cols, a.rows) <= 2 * kScikitImage.radius_px) return {};
  return MeanSimilarity(a, b, kScikitImage, Levels);
}

double SsimY(const cv::Mat& a, const cv::Mat& b) { return MeanSimilarity(a, b, kRestormer, LumaLevels); }

}  // namespace shimmer::restore
