// Sharpening by networks.
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/torch/torch_library.h"
#include "restore/torch/torch_module.h"

namespace shimmer::restore {
namespace {

class TorchSharpening : public SharpeningNetwork {
 public:
  explicit TorchSharpening(ImportedModel model) : model_(std::move(model)) {
    torch::jit::ExtraFilesMap no_extra;
    try {
      module_ = LoadModule(model_.file.string(), no_extra);
    } catch (const std::exception& error) {
      Refuse("can't be loaded, " + WhatTorchSays(error));
    }
  }

  std::string name() const override { return model_.name; }
  TileSize tile() const override { return model_.tile; }

  cv::Mat Sharpened(const cv::Mat& picture) override {
    const cv::Mat whole = picture.isContinuous() ? picture : picture.clone();
    at::Tensor made;
    try {
      const c10::IValue given =
          Run(module_, {torch::from_blob(whole.data, {1, whole.rows, whole.cols, 3}, torch::kFloat32)
                            .permute({0, 3, 1, 2})
                            .clone(at::MemoryFormat::Contiguous)});
      if (given.isTensor()) made = given.toTensor().to(torch::kFloat32);
    } catch (const std::exception& error) {
      Refuse("fails on a tile, " + WhatTorchSays(error));
    }
    if (!made.defined() || made.sizes() != at::IntArrayRef({1, 3, whole.rows, whole.cols}))
      Refuse("gives something else than a tile for a tile");
    if (!made.isfinite().all().item<bool>()) Refuse("gives values that are not finite");
    const at::Tensor px = made[0].permute({1, 2, 0}).contiguous();
    return cv::Mat(whole.size(), CV_32FC3, px.data_ptr<float>()).clone();
  }

 private:
  [[noreturn]] void Refuse(const std::string& why) const {
    throw std::runtime_error(
        model_.file.string() + ": " + why +
        ". Must be TorchScript that takes float 1x3xHxW, RGB in [0, 1], and gives the same");
  }

  ImportedModel model_;
  torch::jit::Module module_;
};

}  // namespace

extern "C" void ShimmerMakeTorchSharpening(const ImportedModel& model,
                                           std::shared_ptr<SharpeningNetwork>& network) {
  network = std::make_shared<TorchSharpening>(model);
}

}  // namespace shimmer::restore
