// shimmer preview DIR --out sheet.png | clip.gif
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

#include "sim/dataset/dataset_reader.h"

namespace shimmer::app {

struct PreviewOptions {
  std::filesystem::path folder, out;
  int64_t clip = -1;  // of the animation; -1: the first that is done
  int rows = 8;       // of the sheet, spread over the data set
};

// The middle frame of up to `rows` clips, spread over the data set: clean, turbulent, tilt as colours, sigma
// as heat. Tilt and sigma that were not written are computed again from the config, but where objects have
// distances of their own: there they are absent. With truth of moving scenes, the masks' outlines and the
// camera's path are drawn over the frames. Gives CV_8UC3 RGB. Throws std::runtime_error where a file can't be
// read, or if no clip is done.
cv::Mat ContactSheet(const dataset::DatasetReader& reader, int rows);

// Draws a contact sheet or an animation of one clip. Throws std::invalid_argument for another extension or a
// clip that is not there, std::runtime_error where a file can't be read or written.
void Preview(const PreviewOptions& options);

}  // namespace shimmer::app
