#include "restore/mask_cleaning.h"

#include <opencv2/imgproc.hpp>
#include <vector>

namespace shimmer::restore {
namespace {

constexpr int kGap_px = 4;  // between parts of one object, to either side

// Keeps the groups of `mask` for which that is so of (label's area, number of its px with seed != 0).
template <class Keep>
cv::Mat Groups(const cv::Mat& mask, const cv::Mat& seed, const Keep& keep) {
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8, CV_32S);
  std::vector<int> seeds(static_cast<size_t>(count));
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (seed.at<uint8_t>(y, x) != 0) ++seeds[static_cast<size_t>(labels.at<int>(y, x))];
  cv::Mat kept = cv::Mat::zeros(mask.size(), CV_8UC1);
  std::vector<uint8_t> value(static_cast<size_t>(count));
  for (int i = 1; i < count; ++i)
    value[static_cast<size_t>(i)] =
        keep(stats.at<int>(i, cv::CC_STAT_AREA), seeds[static_cast<size_t>(i)]) ? 255 : 0;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      kept.at<uint8_t>(y, x) = value[static_cast<size_t>(labels.at<int>(y, x))];
  return kept;
}

}  // namespace

cv::Mat Disc(int radius_px) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1});
}

cv::Mat MovingObjects(const cv::Mat& distance, double threshold, const cv::Mat& sure, int least_px) {
  cv::Mat beyond = distance > threshold;
  cv::morphologyEx(beyond, beyond, cv::MORPH_CLOSE, Disc(kGap_px));
  cv::Mat objects = Groups(beyond, sure, [&](int area, int seeds) { return area >= least_px && seeds > 0; });
  // Holes no larger than half of the objects they are in.
  cv::Mat filled = objects.clone();
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> tree;
  cv::findContours(objects, outlines, tree, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  for (size_t i = 0; i < outlines.size(); ++i) {
    const int parent = tree[i][3];
    if (parent >= 0 &&
        2 * cv::contourArea(outlines[i]) < cv::contourArea(outlines[static_cast<size_t>(parent)]))
      cv::drawContours(filled, outlines, static_cast<int>(i), 255, cv::FILLED);
  }
  return filled;
}

cv::Mat Holding(const cv::Mat& mask, const cv::Mat& places, int least_px) {
  return Groups(mask, places & mask, [&](int, int held) { return held >= least_px; });
}

cv::Mat Persistent(const cv::Mat& mask, const cv::Mat& before, const cv::Mat& after, int reach_px) {
  if (before.empty() && after.empty()) return mask;
  cv::Mat others = cv::Mat::zeros(mask.size(), CV_8UC1);
  if (!before.empty()) others |= before;
  if (!after.empty()) others |= after;
  const int side = 2 * reach_px + 1;
  cv::dilate(others, others, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  return Holding(mask, others, 1);
}

}  // namespace shimmer::restore
