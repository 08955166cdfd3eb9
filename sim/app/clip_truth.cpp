#include "sim/app/clip_truth.h"

#include <algorithm>

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/pixel_hash.h"

namespace shimmer::app {
namespace {

dataset::ClipFile FloatFile(const cv::Mat& picture, const std::vector<std::string>& channels) {
  return {"", dataset::EncodeExr(picture, 32, channels),
          dataset::PixelHash(picture, {dataset::FileFormat::kExr, 32})};
}

}  // namespace

dataset::ClipFile PictureFile(const cv::Mat& image, dataset::Encoding encoding) {
  return {"", dataset::EncodeImage(image, encoding), dataset::PixelHash(image, encoding)};
}

dataset::ClipFile TruthFile(const sim::FrameTruth& frame, const std::vector<std::string>& truth) {
  const auto wanted = [&](const char* kind) { return std::ranges::count(truth, kind) > 0; };
  std::vector<std::string> channels;
  std::vector<cv::Mat> planes;
  if (wanted("tilt")) {
    channels = {"dx", "dy"};
    cv::split(frame.tilt, planes);
  }
  if (wanted("sigma")) {
    channels.push_back("sigma");
    planes.push_back(frame.sigma);
  }
  cv::Mat picture;
  cv::merge(planes, picture);
  return FloatFile(picture, channels);
}

dataset::ClipFile MaskFile(const cv::Mat& coverage) {
  return PictureFile(coverage, {.format = dataset::FileFormat::kPng, .bits = 8});
}

dataset::ClipFile FlowFile(const cv::Mat& flow) {
  return FloatFile(flow, {dataset::kFlowChannels.begin(), dataset::kFlowChannels.end()});
}

dataset::ClipFile ShakeFile(const std::vector<cv::Point2d>& shifts) {
  dataset::Json list = dataset::Json::array();
  for (const cv::Point2d& shift : shifts) list.push_back({shift.x, shift.y});
  const std::string text = dataset::Json{{dataset::kShakeKey, list}}.dump() + "\n";
  return {"", {text.begin(), text.end()}, ""};
}

}  // namespace shimmer::app
