#include "restore/shift_search.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace shimmer::restore {
namespace {

constexpr double kMedianOfNormal = 0.6745;  // of the size of a normal number

cv::Mat Spectrum(const cv::Mat& values, cv::Size size) {
  cv::Mat padded = cv::Mat::zeros(size, CV_32FC1), spectrum;
  values.copyTo(padded({{0, 0}, values.size()}));
  cv::dft(padded, spectrum, 0, values.rows);
  return spectrum;
}

// Sum of a(q) b(q + o) for 0 <= o < places, from the spectra of a and b.
cv::Mat Correlations(const cv::Mat& a, const cv::Mat& b, cv::Size places) {
  cv::Mat product, sums;
  cv::mulSpectrums(b, a, product, 0, true);
  cv::dft(product, sums, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT, places.height);
  return sums({{0, 0}, places});
}

// Sums of values over windows of that size at 0 <= o < places.
cv::Mat WindowSums(const cv::Mat& values, cv::Size window, cv::Size places) {
  cv::Mat integral;
  cv::integral(values, integral, CV_64F);
  const auto at = [&](int x, int y) { return integral({{x, y}, places}); };
  cv::Mat sums = at(window.width, window.height) - at(0, window.height) - at(window.width, 0) + at(0, 0);
  sums.convertTo(sums, CV_32F);
  return sums;
}

// Where a parabola through three scores has its top, from the middle one.
double Top(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend < 0 ? std::clamp((before - after) / (2 * bend), -0.5, 0.5) : 0;
}

}  // namespace

std::vector<ShiftPeak> BestShifts(const cv::Mat& detail, const Mosaic& mosaic, int count) {
  const int margin = mosaic.margin_px();
  const cv::Size canvas = mosaic.whole().mean.size(), places(2 * margin + 1, 2 * margin + 1);
  // The frame lies on the canvas wherever it is, so that nothing comes round from the other side.
  const cv::Size size(cv::getOptimalDFTSize(canvas.width), cv::getOptimalDFTSize(canvas.height));
  cv::Mat seen;
  cv::min(mosaic.whole().frames, 1, seen);
  cv::Mat products, frame_energy;
  tbb::parallel_invoke(
      [&] { products = Correlations(Spectrum(detail, size), Spectrum(mosaic.whole().mean, size), places); },
      [&] { frame_energy = Correlations(Spectrum(detail.mul(detail), size), Spectrum(seen, size), places); });
  const cv::Mat mosaic_energy =
      WindowSums(mosaic.whole().mean.mul(mosaic.whole().mean), detail.size(), places);
  const cv::Mat seen_px = WindowSums(seen, detail.size(), places);

  const double frame_px = static_cast<double>(detail.total());
  const float least = static_cast<float>(1e-6 * std::max(cv::norm(detail, cv::NORM_L2SQR), 1e-30));
  cv::Mat_<float> scores(places, -1.0f), correlations(places, -1.0f);
  std::vector<float> sizes;
  for (int y = 0; y < places.height; ++y)
    for (int x = 0; x < places.width; ++x) {
      const float a = frame_energy.at<float>(y, x), b = mosaic_energy.at<float>(y, x);
      const double overlap = seen_px.at<float>(y, x) / frame_px;
      if (overlap < kLeastOverlap || a <= least || b <= least) continue;
      correlations(y, x) = products.at<float>(y, x) / std::sqrt(a * b);
      scores(y, x) = static_cast<float>(correlations(y, x) * std::sqrt(overlap));
      sizes.push_back(std::abs(scores(y, x)));
    }
  if (sizes.empty()) return {};
  // Most shifts match by chance alone, with a mean of zero: their median size says how well that is.
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double by_chance = std::max(*middle / kMedianOfNormal, 1e-6);

  std::vector<ShiftPeak> peaks;
  for (int y = 0; y < places.height; ++y)
    for (int x = 0; x < places.width; ++x) {
      const float score = scores(y, x);
      if (score <= 0) continue;
      const auto near = [&](int i, int j) {
        const bool inside = x + i >= 0 && x + i < places.width && y + j >= 0 && y + j < places.height;
        return inside ? scores(y + j, x + i) : -1.0f;
      };
      bool highest = true;  // of equals the first
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          if (i != 0 || j != 0)
            highest = highest && (j < 0 || (j == 0 && i < 0) ? near(i, j) < score : near(i, j) <= score);
      if (!highest) continue;
      const auto top = [&](float before, float after) {
        return before < 0 || after < 0 ? 0 : Top(before, score, after);
      };
      const cv::Point2d place(x + top(near(-1, 0), near(1, 0)), y + top(near(0, -1), near(0, 1)));
      peaks.push_back({cv::Point2d(margin, margin) - place, correlations(y, x), score / by_chance});
    }
  const size_t kept = std::min(peaks.size(), static_cast<size_t>(std::max(count, 0)));
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(kept), peaks.end(),
                    [](const ShiftPeak& a, const ShiftPeak& b) { return a.clearness > b.clearness; });
  peaks.resize(kept);
  return peaks;
}

}  // namespace shimmer::restore
