// What is known of a frame, as files beside it (output.truth).
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/clip_fields.h"
#include "sim/dataset/image_io.h"
#include "sim/dataset/staged_clip.h"

namespace shimmer::app {

// A picture's file and the hash of its pixels. The path is left empty, here as below.
dataset::ClipFile PictureFile(const cv::Mat& image, dataset::Encoding encoding);

// tilt as dx and dy, and sigma: those of them that truth names. EXR, float32.
dataset::ClipFile TruthFile(const sim::FrameTruth& frame, const std::vector<std::string>& truth);

// coverage: CV_32FC1 in [0, 1]. PNG of 8 bits.
dataset::ClipFile MaskFile(const cv::Mat& coverage);

// flow: CV_32FC2, px. EXR, float32, channels u and v.
dataset::ClipFile FlowFile(const cv::Mat& flow);

// One shift a frame, px. JSON, numbers in their shortest form that reads back as the same.
dataset::ClipFile ShakeFile(const std::vector<cv::Point2d>& shifts);

}  // namespace shimmer::app
