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

void LocalMean(const cv::Mat& values, const Window& window, cv::Mat& mean) {
  const int side = 2 * window.radius_px + 1;
  if (window.sigma_px > 0) {
    const cv::Mat kernel = cv::getGaussianKernel(side, window.sigma_px, CV_64F);
    cv::sepFilter2D(values, mean, CV_64F, kernel, kernel, {-1, -1}, 0, window.border);
  } else {
    cv::boxFilter(values, mean, CV_64F, {side, side}, {-1, -1}, true, window.border);
  }
}

// Memory for rows of a frame, used again by a thread: fresh pages cost as much as the work in them.
struct Scratch {
  cv::Mat sum, difference, square, mean_sum, mean_difference, square_sum, square_difference;
};

// Of each sample in these rows of levels, CV_64F of as many columns as a row has samples. From the sum s and
// the difference d of the two, which need four means where a and b need five: the variance of s is va + vb +
// 2 cab, that of d is va + vb - 2 cab.
cv::Mat Similarity(const cv::Mat& a, const cv::Mat& b, const Window& window, cv::Range rows) {
  thread_local Scratch scratch;
  auto& [sum, difference, square, mean_sum, mean_difference, square_sum, square_difference] = scratch;
  cv::add(a, b, sum);
  cv::subtract(a, b, difference);
  LocalMean(sum, window, mean_sum);
  LocalMean(difference, window, mean_difference);
  cv::multiply(sum, sum, square);
  LocalMean(square, window, square_sum);
  cv::multiply(difference, difference, square);
  LocalMean(square, window, square_difference);
  cv::Mat similarity(rows.size(), a.cols * a.channels(), CV_64F);
  for (int y = rows.start; y < rows.end; ++y) {
    const auto *ms = mean_sum.ptr<double>(y), *md = mean_difference.ptr<double>(y);
    const auto *ss = square_sum.ptr<double>(y), *sd = square_difference.ptr<double>(y);
    auto* out = similarity.ptr<double>(y - rows.start);
    for (int i = 0; i < similarity.cols; ++i) {
      const double of_sum = ms[i] * ms[i], of_difference = md[i] * md[i];
      const double variance_sum = window.variance_factor * (ss[i] - of_sum),
                   variance_difference = window.variance_factor * (sd[i] - of_difference);
      out[i] = ((of_sum - of_difference) / 2 + kC1) * ((variance_sum - variance_difference) / 2 + kC2) /
               (((of_sum + of_difference) / 2 + kC1) * ((variance_sum + variance_difference) / 2 + kC2));
    }
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
