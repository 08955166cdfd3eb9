// Where a frame shows one colour and nothing else: neither tilt nor blur can change it there.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::sim {

class ConstantRegions {
 public:
  // frame: any type. Looked at in blocks; one that varies is left at its first pixel that differs, so that a
  // photograph costs next to nothing.
  explicit ConstantRegions(const cv::Mat& frame);

  // True only if all pixels of an area of the frame are the same. Judged by whole blocks: a constant area may
  // be overlooked by up to a block on each side.
  bool IsConstant(cv::Rect area) const;

  // The stretches [start, end) of an area's columns in which it is not constant `reach_px` px around, in
  // multiples of a block from the area's left edge. Empty if it is constant all over.
  std::vector<cv::Range> Varied(cv::Rect area, int reach_px) const;

  // The blocks of an area, which may have changed, are varied from now on.
  void SetVaried(cv::Rect area);

  bool any() const { return any_; }  // false: nothing is constant, and nobody need ask

 private:
  cv::Mat frame_;     // to compare blocks with one another
  cv::Mat constant_;  // CV_8UC1, a byte a block: 1 if it is constant
  bool any_ = false;
};

}  // namespace shimmer::sim
