#include "restore/torch_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "restore/imported_model.h"
#include "restore/open_network.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::restore {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

const fs::path kData = fs::path(SHIMMER_SOURCE_DIR) / "tests/restore/data";

TEST(TorchNetwork, MakesOfATileWhatPyTorchMakes) {
  const auto network = OpenNetwork(kData / "fine.pt");
  EXPECT_EQ(network->name(), "fine");
  EXPECT_EQ(network->tile(), (TileSize{.side_px = 32, .overlap_px = 4, .fixed = true}));
  const ImportedModel model = ReadImportedModel(kData / "fine.pt");
  EXPECT_LE(cv::norm(network->Sharpened(model.sample_input), model.sample_output, cv::NORM_INF), 1e-6);
}

TEST(TorchNetwork, ThatIsNoneIsRefused) {
  const dataset::TempFolder folder;
  fs::copy_file(kData / "fine.onnx", folder.path() / "onnx.pt");
  fs::copy_file(kData / "fine.pt.safetensors", folder.path() / "onnx.pt.safetensors");
  EXPECT_THAT([&] { OpenNetwork(folder.path() / "onnx.pt"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("onnx.pt: can't be loaded, torch says: ")));
}

TEST(TorchNetwork, WithASampleOfAnotherIsRefused) {
  const dataset::TempFolder folder;
  fs::copy_file(kData / "fine.pt", folder.path() / "other.pt");
  fs::copy_file(kData / "normalised.onnx.safetensors", folder.path() / "other.pt.safetensors");
  EXPECT_THAT(
      [&] { OpenNetwork(folder.path() / "other.pt"); },
      ThrowsMessage<std::runtime_error>(HasSubstr("other.pt: makes something else of its recorded sample")));
}

}  // namespace
}  // namespace shimmer::restore
