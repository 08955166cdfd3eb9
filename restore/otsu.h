// Otsu's threshold (1979) of a histogram that is pooled over frames.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

// Values in bins of one width from 0; those of `most` and above are in the last.
class PooledHistogram {
 public:
  // Throws std::invalid_argument unless bins >= 2 and most > 0.
  PooledHistogram(double most, int bins = 1024);

  // values: CV_32FC1, 0 or more; counted where use (CV_8UC1 of its size) is not 0. Not finite ones are not.
  void Add(const cv::Mat& values, const cv::Mat& use);

  int64_t Count() const;

  // The upper edge of the bin that parts the values in two classes of the largest variance between them (the
  // mean of such edges, if there are several: of classes with nothing between them, the middle). 0 if all
  // values are in one bin, or there are none.
  double OtsuThreshold() const;

  // The value below which that part of them is, in [0, 1], to a bin. 0 if there are none.
  double Quantile(double part) const;

 private:
  double width_;
  std::vector<int64_t> counts_;
};

}  // namespace shimmer::restore
