// The pictures of a clip for the report (pictures.h), collected while its frames come out.
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "restore/app/evaluation/true_frame.h"
#include "restore/stability.h"
#include "restore/stages.h"

namespace shimmer::restore::app {

class ClipPictures {
 public:
  ClipPictures(TrueClip& clip, std::filesystem::path folder);
  void Add(const FrameOnWay& frame, const TrueFrame& truth);
  void Finish();  // writes them; throws std::runtime_error where that can't be

 private:
  TrueClip& clip_;
  std::filesystem::path folder_;
  std::map<std::string, cv::Mat> pictures_;  // by file name, CV_8UC3 RGB
  TimeSlice input_rows_, result_rows_, truth_rows_;
};

}  // namespace shimmer::restore::app
