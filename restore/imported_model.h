// What lies beside a network that something else runs (ONNX, TorchScript): how large a picture it takes, and
// what it makes of one, by which it is checked before it is used.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

// Importers may be wrong without a word: OpenCV 4.6 normalises otherwise than PyTorch, which shows as 0.05 of
// the range. Correct ones differ by the order of their sums, 1e-5. This is an eighth of a level of 255.
inline constexpr double kMostSampleError = 5e-4;

struct ImportedModel {
  std::filesystem::path file;  // of the network
  std::string name;
  TileSize tile = {};
  cv::Mat sample_input, sample_output;  // CV_32FC3, of a tile's size
};

// Reads FILE.safetensors, of the network in FILE: its metadata's card is JSON with "format" 1, "name", "tile"
// and "overlap", px, and its tensors sample.input and sample.output are 3 x tile x tile. Throws
// std::runtime_error with the file and what is wrong.
ImportedModel ReadImportedModel(const std::filesystem::path& network);

// Throws std::runtime_error where the network makes something else of the recorded sample.
void CheckSample(SharpeningNetwork& network, const ImportedModel& model);

}  // namespace shimmer::restore
