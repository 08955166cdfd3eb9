#include "restore/ssim.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "restore/levels.h"
#include "restore/regions.h"

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

// Of each sample in these rows of levels, CV_64F of as many columns as a row has samples.
cv::Mat Similarity(const cv::Mat& a, const cv::Mat& b, const Window& window, cv::Range rows) {
  const cv::Mat mean_a = LocalMean(a, window), mean_b = LocalMean(b, window);
  const cv::Mat square_a = LocalMean(a.mul(a), window), square_b = LocalMean(b.mul(b), window),
                product = LocalMean(a.mul(b), window);
  cv::Mat similarity(rows.size(), a.cols * a.channels(), CV_64F);
  for (int y = rows.start; y < rows.end; ++y)
    for (int i = 0; i < similarity.cols; ++i) {
      const double ma = mean_a.ptr<double>(y)[i], mb = mean_b.ptr<double>(y)[i];
      const double variances = square_a.ptr<double>(y)[i] - ma * ma + (square_b.ptr<double>(y)[i] - mb * mb);
      const double covariance = product.ptr<double>(y)[i] - ma * mb;
      similarity.at<double>(y - rows.start, i) =
          (2 * ma * mb + kC1) * (2 * window.variance_factor * covariance + kC2) /
          ((ma * ma + mb * mb + kC1) * (window.variance_factor * variances + kC2));
    }
  return similarity;
}

// The same of rows of two frames.
template <class LevelsOf>
cv::Mat SimilarityOfRows(const cv::Mat& a, const cv::Mat& b, const Window& window, cv::Range rows,
                         const LevelsOf& levels_of) {
  const int channels = RequireFramePair(a, b);
  // What their windows see; at the frame's border OpenCV adds what lies beyond.
  const cv::Range seen(std::max(rows.start - window.radius_px, 0),
                       std::min(rows.end + window.radius_px, a.rows));
  return Similarity(levels_of(a, seen, channels), levels_of(b, seen, channels), window,
                    {rows.start - seen.start, rows.end - seen.start});
}

template <class LevelsOf>
double MeanSimilarity(const cv::Mat& a, const cv::Mat& b, const Window& window, const LevelsOf& levels_of) {
  RequireFramePair(a, b);
  const int cropped = window.cropped_px;
  double sum = 0, counted = 0;
  ForRows(a.rows - 2 * cropped, [&](cv::Range counting) {
    const cv::Mat similarity =
        SimilarityOfRows(a, b, window, {counting.start + cropped, counting.end + cropped}, levels_of);
    const int used = similarity.cols / a.cols;  // channels; Y is one
    for (int y = 0; y < similarity.rows; ++y) {
      const auto* row = similarity.ptr<double>(y);
      for (int i = cropped * used; i < (a.cols - cropped) * used; ++i) sum += row[i];
    }
    counted += static_cast<double>(counting.size()) * (a.cols - 2 * cropped) * used;
  });
  return sum / counted;
}

}  // namespace

double SsimOpenCv(const cv::Mat& a, const cv::Mat& b) { return MeanSimilarity(a, b, kOpenCv, Levels); }

std::vector<std::optional<double>> SsimIn(const cv::Mat& a, const cv::Mat& b,
                                          std::span<const cv::Mat> regions) {
  RequireFramePair(a, b);
  return MeansIn(a.size(), regions,
                 [&](cv::Range rows) { return SimilarityOfRows(a, b, kOpenCv, rows, Levels); });
}

std::optional<double> SsimScikitImage(const cv::Mat& a, const cv::Mat& b) {
  RequireFramePair(a, b);
  if (std::min(a.cols, a.rows) <= 2 * kScikitImage.radius_px) return {};
  return MeanSimilarity(a, b, kScikitImage, Levels);
}

double SsimY(const cv::Mat& a, const cv::Mat& b) { return MeanSimilarity(a, b, kRestormer, LumaLevels); }

}  // namespace shimmer::restore
