#include "restore/psnr.h"

#include <cmath>

#include "restore/levels.h"

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

template <class LevelsOf>
double PsnrOf(const cv::Mat& a, const cv::Mat& b, const LevelsOf& levels_of) {
  const int channels = RequireFramePair(a, b);
  double sum = 0;
  ForRows(a.rows, [&](cv::Range rows) {
    sum += SquaredDifference(levels_of(a, rows, channels), levels_of(b, rows, channels));
  });
  return 10 * std::log10(255.0 * 255.0 * a.rows / sum);
}

}  // namespace

double Psnr(const cv::Mat& a, const cv::Mat& b) { return PsnrOf(a, b, Levels); }
double PsnrY(const cv::Mat& a, const cv::Mat& b) { return PsnrOf(a, b, LumaLevels); }

}  // namespace shimmer::restore
