// The network that sharpens, from whatever file it is in.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

// By the name's end: .safetensors, weights of a Restormer (restormer.h); .onnx (onnx_network.h); .pt,
// TorchScript (torch_network.h). Throws std::invalid_argument for another, and as these do.
std::shared_ptr<SharpeningNetwork> OpenNetwork(const std::filesystem::path& file);

// That which the program carries: restore/models/shimmer.safetensors, trained by scripts/train/reproduce.sh.
std::shared_ptr<SharpeningNetwork> ShippedNetwork();
std::span<const unsigned char> ShippedModel();  // its file

}  // namespace shimmer::restore
