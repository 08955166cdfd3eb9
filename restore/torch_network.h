// Sharpening by any network that is saved as TorchScript.
#pragma once

#include <filesystem>
#include <memory>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

// The network takes float 1x3xSxS, RGB in [0, 1], and gives the same; S is the tile of the card beside it
// (imported_model.h). Computed on one thread. Throws std::invalid_argument where this build has no torch, and
// std::runtime_error with the file: what torch says of it, and what CheckSample refuses.
std::shared_ptr<SharpeningNetwork> OpenTorchNetwork(const std::filesystem::path& file);

}  // namespace shimmer::restore
