#include "restore/torch_flow.h"

#include <stdexcept>

#include "restore/torch/torch_library.h"

namespace shimmer::restore {

FlowMaker TorchFlows(const std::filesystem::path& network) {
  const auto make = reinterpret_cast<MakeTorchFlows*>(TorchFunction(kMakeTorchFlows, network, "dis"));
  if (!std::filesystem::is_regular_file(network))
    throw std::runtime_error(network.string() + ": is not there, must be dis or the file of a network");
  FlowMaker flows;
  make(network, flows);
  return flows;
}

}  // namespace shimmer::restore
