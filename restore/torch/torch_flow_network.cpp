// Flow by networks.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "restore/torch/torch_library.h"
#include "restore/torch/torch_module.h"

namespace shimmer::restore {
namespace {

constexpr int kMultiple_px = 8;     // RAFT works at an eighth of the size,
constexpr int kLeastSide_px = 128;  // and halves that three times
constexpr const char* kRange = "range";

[[noreturn]] void Refuse(const std::string& network, const std::string& why) {
  throw std::runtime_error(
      network + ": " + why +
      ". Must be TorchScript that takes two images 1x3xHxW and gives their flow 1x2xHxW, or a list of flows");
}

std::string SizeText(const cv::Mat& image) {
  return std::to_string(image.cols) + "x" + std::to_string(image.rows) + " px";
}

// The last of a tuple or list. Undefined where there is none.
at::Tensor FinestOf(const c10::IValue& given) {
  if (given.isTensor()) return given.toTensor();
  if (given.isTuple() && !given.toTupleRef().elements().empty())
    return FinestOf(given.toTupleRef().elements().back());
  if (given.isList() && !given.toListRef().empty()) return FinestOf(given.toListRef().back());
  return {};
}

// For any number of threads at a time.
class Network {
 public:
  explicit Network(const std::string& path) : path_(path) {
    torch::jit::ExtraFilesMap extra{{kRange, ""}};
    try {
      module_ = LoadModule(path, extra);
    } catch (const std::exception& error) {
      Refuse(path_, "can't be loaded, " + WhatTorchSays(error));
    }
    ReadRange(extra[kRange]);
  }

  // Of sides that it can take.
  cv::Mat Flow(const cv::Mat& from, const cv::Mat& to) const {
    at::Tensor flow;
    try {
      flow = FinestOf(Run(module_, {ImageOf(from), ImageOf(to)}));
      if (flow.defined()) flow = flow.to(torch::kFloat32);
    } catch (const std::exception& error) {
      Refuse(path_, "fails on two images of " + SizeText(from) + ", " + WhatTorchSays(error));
    }
    if (!flow.defined()) Refuse(path_, "gives no flow of two images of " + SizeText(from));
    if (flow.sizes() != at::IntArrayRef({1, 2, from.rows, from.cols}))
      Refuse(path_, "gives " + c10::str(flow.sizes()) + " of two images of " + SizeText(from));
    if (!flow.isfinite().all().item<bool>())
      Refuse(path_, "gives a flow that is not finite of two images of " + SizeText(from));
    const at::Tensor px = flow[0].permute({1, 2, 0}).contiguous();
    return cv::Mat(from.size(), CV_32FC2, px.data_ptr<float>()).clone();
  }

 private:
  void ReadRange(const std::string& text) {
    if (text.empty()) return;
    std::istringstream numbers(text);
    std::string rest;
    if (!(numbers >> black_ >> white_) || numbers >> rest || !(black_ < white_))
      throw std::runtime_error(path_ + ": range is '" + text +
                               "', must be what the network takes for black and for white, as '-1 1'");
  }

  at::Tensor ImageOf(const cv::Mat& frame) const {
    cv::Mat samples;
    frame.convertTo(samples, CV_32F, (white_ - black_) / 255, black_);
    if (samples.channels() == 1) cv::merge(std::vector<cv::Mat>(3, samples), samples);
    return torch::from_blob(samples.data, {1, samples.rows, samples.cols, 3}, torch::kFloat32)
        .permute({0, 3, 1, 2})
        .clone(at::MemoryFormat::Contiguous);
  }

  std::string path_;
  torch::jit::Module module_;
  double black_ = 0, white_ = 255;
};

class TorchFlow : public DenseFlow {
 public:
  explicit TorchFlow(std::shared_ptr<const Network> network) : network_(std::move(network)) {}

  cv::Mat Compute(const cv::Mat& from, const cv::Mat& to) override {
    const auto missing = [](int side_px) {
      return std::max(kLeastSide_px, (side_px + kMultiple_px - 1) / kMultiple_px * kMultiple_px) - side_px;
    };
    const int x = missing(from.cols), y = missing(from.rows);
    const auto padded = [&](const cv::Mat& frame) {
      cv::Mat result;
      cv::copyMakeBorder(frame, result, y / 2, y - y / 2, x / 2, x - x / 2,
                         cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
      return result;
    };
    return network_->Flow(padded(from), padded(to))(cv::Rect({x / 2, y / 2}, from.size())).clone();
  }

  std::vector<cv::Mat> ComputeAll(const cv::Mat& from, const std::vector<cv::Mat>& to) override {
    std::vector<cv::Mat> flows(to.size());
    tbb::parallel_for(size_t{0}, to.size(), [&](size_t k) { flows[k] = Compute(from, to[k]); });
    return flows;
  }

 private:
  std::shared_ptr<const Network> network_;
};

// Two small frames: what is no flow network says so before a video is read.
void Try(TorchFlow& flow) {
  cv::RNG random(1);
  cv::Mat from(131, 137, CV_8UC3), to = from.clone();
  random.fill(from, cv::RNG::UNIFORM, 0, 256);
  random.fill(to, cv::RNG::UNIFORM, 0, 256);
  flow.Compute(from, to);
}

}  // namespace

extern "C" void ShimmerMakeTorchFlows(const std::filesystem::path& network, FlowMaker& flows) {
  const auto loaded = std::make_shared<const Network>(network.string());
  TorchFlow flow(loaded);
  Try(flow);
  flows = [loaded] { return std::make_unique<TorchFlow>(loaded); };
}

}  // namespace shimmer::restore
