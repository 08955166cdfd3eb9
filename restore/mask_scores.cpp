#include "restore/mask_scores.h"

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

double Share(int64_t part, int64_t whole) {
  return whole == 0 ? 1 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

cv::Mat MovingPixels(const cv::Mat& mask) {
  RequireFrame(mask, "mask");
  cv::Mat moving(mask.size(), CV_8UC1);
  ForRows(mask.rows, [&](cv::Range rows) {
    const cv::Mat levels = Levels(mask, rows, mask.channels());
    const int channels = mask.channels();
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* samples = levels.ptr<double>(y - rows.start);
      for (int x = 0; x < mask.cols; ++x) {
        double sum = 0;
        for (int c = 0; c < channels; ++c) sum += samples[x * channels + c];
        moving.at<uint8_t>(y, x) = sum >= 127.5 * channels ? 255 : 0;
      }
    }
  });
  return moving;
}

MaskCounts& MaskCounts::operator+=(const MaskCounts& other) {
  both += other.both;
  only_found += other.only_found;
  only_true += other.only_true;
  return *this;
}

double MaskCounts::Iou() const { return Share(both, both + only_found + only_true); }
double MaskCounts::Precision() const { return Share(both, both + only_found); }
double MaskCounts::Recall() const { return Share(both, both + only_true); }

MaskCounts CompareMasks(const cv::Mat& found, const cv::Mat& truth) {
  RequireFramePair(found, truth);
  const cv::Mat is_found = MovingPixels(found), is_true = MovingPixels(truth);
  const int64_t both = cv::countNonZero(is_found & is_true);
  return {.both = both,
          .only_found = cv::countNonZero(is_found) - both,
          .only_true = cv::countNonZero(is_true) - both};
}

}  // namespace shimmer::restore
