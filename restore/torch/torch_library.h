// What the library offers that is linked with torch. It is loaded only once a network is asked for: torch
// takes longer to start than all else of the program.
#pragma once

#include <filesystem>
#include <memory>

#include "restore/flow.h"
#include "restore/imported_model.h"

namespace shimmer::restore {

inline constexpr const char* kTorchLibrary = "libshimmer_torch.so";
inline constexpr const char* kMakeTorchFlows = "ShimmerMakeTorchFlows";
inline constexpr const char* kMakeTorchSharpening = "ShimmerMakeTorchSharpening";

// TorchFlows (torch_flow.h).
extern "C" using MakeTorchFlows = void(const std::filesystem::path& network, FlowMaker& flows);

// OpenTorchNetwork (torch_network.h), before its sample is checked.
extern "C" using MakeTorchSharpening =
    void(const ImportedModel& model, std::shared_ptr<SharpeningNetwork>& network);

// A function of the library, which is beside the program where the build has it, and stays loaded: what it
// made may live on. file: the network that asks for it; instead: what else the person may ask for. Throws
// std::invalid_argument where this build has no torch, std::runtime_error where it can't be loaded.
void* TorchFunction(const char* name, const std::filesystem::path& file, const char* instead);

}  // namespace shimmer::restore
