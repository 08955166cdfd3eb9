#include "restore/torch_network.h"

#include "restore/imported_model.h"
#include "restore/torch/torch_library.h"

namespace shimmer::restore {

std::shared_ptr<SharpeningNetwork> OpenTorchNetwork(const std::filesystem::path& file) {
  const auto make = reinterpret_cast<MakeTorchSharpening*>(
      TorchFunction(kMakeTorchSharpening, file, "a network in .safetensors or .onnx"));
  const ImportedModel model = ReadImportedModel(file);
  std::shared_ptr<SharpeningNetwork> network;
  make(model, network);
  CheckSample(*network, model);
  return network;
}

}  // namespace shimmer::restore
