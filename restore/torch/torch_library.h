// What the library offers that is linked with torch. It is loaded only once a network is asked for: torch
// takes longer to start than all else of the program.
#pragma once

#include <filesystem>

#include "restore/flow.h"

namespace shimmer::restore {

inline constexpr const char* kTorchLibrary = "libshimmer_torch.so";
inline constexpr const char* kMakeTorchFlows = "ShimmerMakeTorchFlows";

// TorchFlows (torch_flow.h).
extern "C" using MakeTorchFlows = void(const std::filesystem::path& network, FlowMaker& flows);

}  // namespace shimmer::restore
