#include "restore/open_network.h"

#include <stdexcept>
#include <string>

#include "restore/onnx_network.h"
#include "restore/restormer.h"
#include "restore/torch_network.h"

// The file itself, as it lies in the repository, so that the program needs no other beside it.
asm(R"(
  .section .rodata
  .balign 16
  .global shimmer_shipped_model, shimmer_shipped_model_end
shimmer_shipped_model:
  .incbin ")" SHIMMER_MODEL_FILE R"("
shimmer_shipped_model_end:
  .previous
)");
extern "C" const unsigned char shimmer_shipped_model[], shimmer_shipped_model_end[];

namespace shimmer::restore {
namespace {

class RestormerNetwork : public SharpeningNetwork {
 public:
  explicit RestormerNetwork(const SafeTensors& file) : restormer_(file) {}

  std::string name() const override { return restormer_.Card().name; }
  TileSize tile() const override {
    return {.side_px = restormer_.Card().tile_px, .overlap_px = restormer_.Card().overlap_px};
  }
  bool TakesManyAtOnce() const override { return true; }
  cv::Mat Sharpened(const cv::Mat& picture) override {
    const cv::Mat made = restormer_.Run(picture);
    if (!cv::checkRange(made)) throw std::runtime_error(name() + ": gives values that are not finite");
    return made;
  }

 private:
  Restormer restormer_;
};

}  // namespace

std::shared_ptr<SharpeningNetwork> OpenNetwork(const std::filesystem::path& file) {
  const std::string end = file.extension().string();
  if (end == ".safetensors") return std::make_shared<RestormerNetwork>(ReadSafeTensors(file));
  if (end == ".onnx") return OpenOnnxNetwork(file);
  if (end == ".pt") return OpenTorchNetwork(file);
  throw std::invalid_argument(
      file.string() + ": must be weights in .safetensors, or a network in .onnx or .pt (TorchScript)");
}

std::span<const unsigned char> ShippedModel() { return {shimmer_shipped_model, shimmer_shipped_model_end}; }

std::shared_ptr<SharpeningNetwork> ShippedNetwork() {
  const std::string bytes(ShippedModel().begin(), ShippedModel().end());
  return std::make_shared<RestormerNetwork>(ReadSafeTensors(bytes, "the model that unshimmer carries"));
}

}  // namespace shimmer::restore
