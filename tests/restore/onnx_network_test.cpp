#include "restore/onnx_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "restore/imported_model.h"
#include "restore/open_network.h"
#include "restore/sharpen.h"
#include "tests/dataset/temp_folder.h"
#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const fs::path kData = fs::path(SHIMMER_SOURCE_DIR) / "tests/restore/data";

auto Refuses(const std::string& part, const std::string& other = "") {
  return ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(part), HasSubstr(other)));
}

// Copies of the networks, so that files can be left out and damaged.
class OnnxNetwork : public testing::Test {
 protected:
  fs::path Copied(const std::string& name, const std::string& from) {
    fs::copy_file(kData / from, folder_ / name, fs::copy_options::overwrite_existing);
    return folder_ / name;
  }

 private:
  dataset::TempFolder folder_;
};

TEST_F(OnnxNetwork, MakesOfATileWhatPyTorchMakes) {
  const auto network = OpenNetwork(kData / "fine.onnx");
  EXPECT_EQ(network->name(), "fine");
  EXPECT_EQ(network->tile(), (TileSize{.side_px = 32, .overlap_px = 4, .fixed = true}));
  const ImportedModel model = ReadImportedModel(kData / "fine.onnx");
  EXPECT_LE(cv::norm(network->Sharpened(model.sample_input), model.sample_output, cv::NORM_INF), 1e-6);
  EXPECT_GE(cv::norm(model.sample_input, model.sample_output, cv::NORM_INF), 0.05);
}

// Its reach is 1 px, less than the overlap: tiles make what one picture would, but for what the fading
// weighs.
TEST_F(OnnxNetwork, SharpensAFrameInTiles) {
  Sharpener sharpener(OpenNetwork(kData / "fine.onnx"), {50, 37});
  const cv::Mat frame = Noise({50, 37}, CV_8UC3, 4);
  const cv::Mat sharp = sharpener.Next(frame);
  EXPECT_EQ(sharp.size(), frame.size());
  EXPECT_GT(cv::norm(sharp, frame, cv::NORM_INF), 5);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 2 * 2}));
}

TEST_F(OnnxNetwork, ThatIsImportedWrongIsRefused) {
  EXPECT_THAT(
      [] { OpenNetwork(kData / "normalised.onnx"); },
      Refuses("normalised.onnx: makes something else of its recorded sample", "must be at most 0.0005"));
}

TEST_F(OnnxNetwork, WithAnOperatorThatOpenCvLacksIsRefusedByItsName) {
  EXPECT_THAT([] { OpenNetwork(kData / "sorting.onnx"); },
              Refuses("sorting.onnx: can't be imported: OpenCV does not run its operator TopK"));
}

TEST_F(OnnxNetwork, WithoutItsSampleIsRefused) {
  const fs::path file = Copied("alone.onnx", "fine.onnx");
  EXPECT_THAT([&] { OpenNetwork(file); }, Refuses("alone.onnx.safetensors must be beside it"));
}

TEST_F(OnnxNetwork, ThatIsDamagedIsRefused) {
  const fs::path file = Copied("short.onnx", "fine.onnx");
  Copied("short.onnx.safetensors", "fine.onnx.safetensors");
  for (const uintmax_t bytes :
       {uintmax_t{0}, uintmax_t{1}, fs::file_size(file) / 2, fs::file_size(file) - 1}) {
    Copied("short.onnx", "fine.onnx");
    fs::resize_file(file, bytes);
    EXPECT_THAT([&] { OpenNetwork(file); }, Refuses("short.onnx: ")) << bytes;
  }
}

TEST_F(OnnxNetwork, WithASampleOfAnotherIsRefused) {
  const fs::path file = Copied("other.onnx", "fine.onnx");
  Copied("other.onnx.safetensors", "normalised.onnx.safetensors");
  EXPECT_THAT([&] { OpenNetwork(file); }, Refuses("other.onnx: makes something else"));
}

TEST(OpenNetwork, NamesWhatItTakes) {
  EXPECT_THAT([] { OpenNetwork("model.pth"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("model.pth: must be weights in .safetensors")));
  for (const char* name : {"absent.onnx", "absent.safetensors"})
    EXPECT_THAT([&] { OpenNetwork(name); }, Refuses(name)) << name;
}

}  // namespace
}  // namespace shimmer::restore
