// Sharpening by any network in an ONNX file, run by OpenCV's dnn.
#pragma once

#include <filesystem>
#include <memory>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

// The network takes float 1x3xSxS, RGB in [0, 1], and gives the same; S is the tile of the card beside it
// (imported_model.h). Throws std::runtime_error with the file: what OpenCV can't import, with its operator,
// and what CheckSample refuses.
std::shared_ptr<SharpeningNetwork> OpenOnnxNetwork(const std::filesystem::path& file);

}  // namespace shimmer::restore
