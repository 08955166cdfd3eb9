#include "restore/imported_model.h"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "restore/model_card.h"
#include "restore/planes.h"
#include "restore/safe_tensors.h"

namespace shimmer::restore {
namespace {

namespace fs = std::filesystem;

cv::Mat Sample(const SafeTensors& file, const std::string& name, int side) {
  const auto found = file.tensors.find(name);
  const std::vector<int64_t> shape{3, side, side};
  if (found == file.tensors.end() || found->second.shape != shape)
    throw std::runtime_error(
        file.file + ": " + name +
        (found == file.tensors.end() ? " is missing" : " is " + ShapeText(found->second.shape)) +
        ", must be " + ShapeText(shape) + ", of the card's tile");
  return PictureOfPlanes(found->second.values.data(), {side, side});
}

}  // namespace

ImportedModel ReadImportedModel(const fs::path& network) {
  const fs::path beside = network.string() + ".safetensors";
  if (!fs::is_regular_file(network))
    throw std::runtime_error(network.string() + ": is not there, must be the file of a network");
  if (!fs::is_regular_file(beside))
    throw std::runtime_error(network.string() + ": " + beside.filename().string() +
                             " must be beside it, with its model card and a recorded sample, as "
                             "scripts/train/export.py writes them");
  const SafeTensors file = ReadSafeTensors(beside);
  const TileCard card = ReadTileCard(file);
  return {.file = network,
          .name = card.name,
          .tile = {.side_px = card.tile_px, .overlap_px = card.overlap_px, .fixed = true},
          .sample_input = Sample(file, "sample.input", card.tile_px),
          .sample_output = Sample(file, "sample.output", card.tile_px)};
}

void CheckSample(SharpeningNetwork& network, const ImportedModel& model) {
  const double error = cv::norm(network.Sharpened(model.sample_input), model.sample_output, cv::NORM_INF);
  if (error <= kMostSampleError) return;
  char text[128];
  std::snprintf(text, sizeof text, "by up to %.2g of the range, must be at most %.2g", error,
                kMostSampleError);
  throw std::runtime_error(model.file.string() +
                           ": makes something else of its recorded sample than where it was "
                           "exported, " +
                           text + ": what runs it here computes a part of it otherwise");
}

}  // namespace shimmer::restore
