// What the benchmarks degrade: a drawn scene, or a photograph from a file.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace shimmer::bench {

class CleanPicture {
 public:
  // A frame of size px. file: a photograph, reflected at its edges until it fills the frame; "": a drawn
  // scene, which goes on. Throws std::runtime_error if the file is no picture.
  CleanPicture(const std::string& file, cv::Size size);

  // With halo_px more on each side: RGB, as a program would hold it in 8 bit, or the same values as CV_32FC3
  // in [0, 1]. Throws std::invalid_argument for a halo of more than 256 px.
  cv::Mat Bytes(int halo_px) const;
  cv::Mat Floats(int halo_px) const;

 private:
  cv::Mat picture_;  // CV_8UC3
};

}  // namespace shimmer::bench
