#include "restore/onnx_network.h"

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/imported_model.h"
#include "restore/planes.h"

namespace shimmer::restore {
namespace {

// OpenCV logs on many lines what it also throws.
class NoLog {
 public:
  NoLog() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~NoLog() { cv::utils::logging::setLogLevel(before_); }
  NoLog(const NoLog&) = delete;
  NoLog& operator=(const NoLog&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

// What OpenCV says of it, in a line; an operator is named as "[TopK@ai.onnx]:(onnx_node!/TopK)".
std::string WhatOpenCvSays(const cv::Exception& error) {
  static const std::regex node(R"(\[(\w+)(?:@[\w.]*)?\]:\((?:onnx_node!)?([^)]*)\))");
  const std::string text = error.err;
  if (std::smatch found; std::regex_search(text, found, node))
    return "OpenCV does not run its operator " + found[1].str() + " (" + found[2].str() + ")";
  return "OpenCV says: " + text.substr(0, text.find('\n'));
}

class OnnxNetwork : public SharpeningNetwork {
 public:
  explicit OnnxNetwork(ImportedModel model) : model_(std::move(model)) {
    const NoLog no_log;
    try {
      net_ = cv::dnn::readNetFromONNX(model_.file.string());
    } catch (const cv::Exception& error) {
      Refuse("can't be imported: " + WhatOpenCvSays(error));
    }
    net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  }

  std::string name() const override { return model_.name; }
  TileSize tile() const override { return model_.tile; }

  cv::Mat Sharpened(const cv::Mat& picture) override {
    const int shape[] = {1, 3, picture.rows, picture.cols};
    std::vector<float> planes = PlanesOf(picture);
    cv::Mat made;
    const NoLog no_log;
    try {
      net_.setInput(cv::Mat(4, shape, CV_32FC1, planes.data()));
      made = net_.forward();
    } catch (const cv::Exception& error) {
      Refuse("fails on a tile: " + WhatOpenCvSays(error));
    }
    if (made.dims != 4 || !std::equal(shape, shape + 4, made.size.p) || made.type() != CV_32FC1)
      Refuse("gives something else than a tile for a tile");
    if (!cv::checkRange(made)) Refuse("gives values that are not finite");
    return PictureOfPlanes(made.ptr<float>(), picture.size());
  }

 private:
  [[noreturn]] void Refuse(const std::string& why) const {
    throw std::runtime_error(model_.file.string() + ": " + why +
                             ". Must take float 1x3xHxW, RGB in [0, 1], and give the same");
  }

  ImportedModel model_;
  cv::dnn::Net net_;
};

}  // namespace

std::shared_ptr<SharpeningNetwork> OpenOnnxNetwork(const std::filesystem::path& file) {
  const ImportedModel model = ReadImportedModel(file);
  auto network = std::make_shared<OnnxNetwork>(model);
  CheckSample(*network, model);
  return network;
}

}  // namespace shimmer::restore
