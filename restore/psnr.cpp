#include "restore/psnr.h"

#include <cmath>

#include "restore/levels.h"
#include "restore/regions.h"

namespace shimmer::restore {
namespace {

double SquaredDifference(const cv::Mat& a, const cv::Mat& b) {
  double sum = 0;
  for (int y = 0; y < a.rows; ++y) {
    const auto *of_a = a.ptr<double>(y), *of_b = b.ptr<double>(y);
    for (int i = 0; i < a.cols * a.channels(); ++i) {
      const double difference = of_a[i] - of_b[i];
      sum += difference * difference;
    }
  }
  return sum / (a.cols * a.channels());
}

double Decibels(double mean_square) { return 10 * std::log10(255.0 * 255.0 / mean_square); }

template <class LevelsOf>
double PsnrOf(const cv::Mat& a, const cv::Mat& b, const LevelsOf& levels_of) {
  const int channels = RequireFramePair(a, b);
  double sum = 0;
  ForRows(a.rows, [&](cv::Range rows) {
    sum += SquaredDifference(levels_of(a, rows, channels), levels_of(b, rows, channels));
  });
  return Decibels(sum / a.rows);
}

}  // namespace

double Psnr(const cv::Mat& a, const cv::Mat& b) { return PsnrOf(a, b, Levels); }

std::vector<std::optional<double>> PsnrIn(const cv::Mat& a, const cv::Mat& b,
                                          std::span<const cv::Mat> regions) {
  const int channels = RequireFramePair(a, b);
  std::vector<std::optional<double>> results = MeansIn(a.size(), regions, [&](cv::Range rows) {
    cv::Mat difference = Levels(a, rows, channels) - Levels(b, rows, channels);
    difference = difference.mul(difference);
    return difference.reshape(1);
  });
  for (std::optional<double>& result : results)
    if (result) result = Decibels(*result);
  return results;
}

double PsnrY(const cv::Mat& a, const cv::Mat& b) { return PsnrOf(a, b, LumaLevels); }

}  // namespace shimmer::restore
