#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "restore/open_network.h"
#include "restore/sharpen.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const fs::path kNetworks = fs::path(SHIMMER_SOURCE_DIR) / "tests/restore/data";
const fs::path kShipped = fs::path(SHIMMER_SOURCE_DIR) / "restore/models/shimmer.safetensors";

// A still camera before air that tilts by 0.7 px.
class Sharpening : public testing::Test {
 protected:
  void Put(const std::string& video, int frames, cv::Size size, int bits = 8) {
    for (int k = 0; k < frames; ++k)
      folder_.Put(
          video + "/" + std::to_string(1000 + k) + ".png",
          dataset::EncodePng(SeenFrame({.size = size, .tilt_rms_px = 0.7, .frame = static_cast<uint32_t>(k)}),
                             bits));
  }
  Ran Restore(const std::string& video, const std::string& out, const Words& more = {}) {
    Words words = {"restore", video, "--out", out, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return Unshimmer(folder_, words);
  }
  // A copy of the weights that ship, for damage.
  fs::path Copied(const std::string& name) {
    fs::copy_file(kShipped, folder_ / name, fs::copy_options::overwrite_existing);
    return folder_ / name;
  }

  const TempFolder folder_;
};

TEST_F(Sharpening, IsWhatTheShippedNetworkMakesOfTheStageBefore) {
  Put("in", 6, {150, 110});
  ExpectDone(Restore("in", "out", {"--stages", "stages"}));
  Sharpener sharpener(ShippedNetwork(), {150, 110});
  for (int k = 0; k < 6; ++k)
    EXPECT_EQ(cv::norm(FrameOf(folder_ / "out", k), sharpener.Next(FrameOf(folder_ / "stages/blended", k)),
                       cv::NORM_INF),
              0);
  const Json counts = Json::parse(ReadText(folder_ / "stages/plan.json")).at("sharpen");
  EXPECT_EQ(counts.at("tiles_computed"), sharpener.counts().computed);
  EXPECT_EQ(counts.at("tiles_kept"), sharpener.counts().kept);
  EXPECT_EQ(counts.at("tiles_computed").get<int>() + counts.at("tiles_kept").get<int>() +
                counts.at("tiles_flat").get<int>(),
            6);
}

TEST_F(Sharpening, IsSwitchedOff) {
  Put("in", 5, {96, 80});
  ExpectDone(Restore("in", "out", {"--no-sharpen", "--stages", "stages"}));
  ExpectDone(Restore("in", "sharp", {"--stages", "sharp.stages"}));
  EXPECT_FALSE(fs::exists(folder_ / "stages/blended"));
  EXPECT_TRUE(Json::parse(ReadText(folder_ / "stages/plan.json")).at("sharpen").is_null());
  for (int k = 0; k < 5; ++k)
    EXPECT_EQ(
        cv::norm(FrameOf(folder_ / "out", k), FrameOf(folder_ / "sharp.stages/blended", k), cv::NORM_INF), 0);
  const Words plan = {"plan", "in", "--quiet"};
  EXPECT_THAT(Unshimmer(folder_, plan).out, HasSubstr(", sharpen\nsharpen   in 1 tile, "));
  EXPECT_THAT(Unshimmer(folder_, {"plan", "in", "--quiet", "--no-sharpen"}).out,
              HasSubstr("  sharpening: it is switched off\n"));
}

TEST_F(Sharpening, IsTheSameOnAnyNumberOfThreads) {
  Put("in", 4, {300, 90});
  for (const char* threads : {"1", "2"}) ExpectDone(Restore("in", threads, {"--threads", threads}));
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(cv::norm(FrameOf(folder_ / "1", k), FrameOf(folder_ / "2", k), cv::NORM_INF), 0);
}

TEST_F(Sharpening, OfOnePictureIsTheNetworks) {
  Put("in", 1, {70, 50}, 16);
  ExpectDone(Restore("in", "out"));
  const cv::Mat frame = FrameOf(folder_ / "in", 0);
  EXPECT_EQ(cv::norm(FrameOf(folder_ / "out", 0), Sharpener(ShippedNetwork(), frame.size()).Next(frame),
                     cv::NORM_INF),
            0);
}

TEST_F(Sharpening, TakesAnotherModel) {
  Put("in", 3, {70, 50});
  for (const fs::path& model : {Copied("copy.safetensors"), kNetworks / "fine.onnx"}) {
    const std::string out = model.stem().string();
    ExpectDone(Restore("in", out, {"--model", model, "--stages", out + ".stages"}));
    Sharpener sharpener(OpenNetwork(model), {70, 50});
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(cv::norm(FrameOf(folder_ / out, k),
                         sharpener.Next(FrameOf(folder_ / (out + ".stages/blended"), k)), cv::NORM_INF),
                0)
          << model;
  }
}

TEST_F(Sharpening, SaysWhatIsWrongWithAModel) {
  Put("in", 2, {70, 50});
  Put("small", 2, {31, 40});
  const auto refuses = [&](const std::string& video, const std::string& model, int exit_code,
                           const Words& parts) {
    ExpectRefused(Restore(video, "out", {"--model", model}), exit_code, parts);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    EXPECT_FALSE(fs::exists(folder_ / "out.part"));
  };
  refuses("in", "absent.safetensors", 1, {"absent.safetensors: cannot be read"});
  refuses("in", "absent.onnx", 1, {"absent.onnx: is not there"});
  refuses("in", "model.pth", 2, {"model.pth: must be weights in .safetensors, or a network in .onnx or .pt"});
  refuses("in", kNetworks / "normalised.onnx", 1,
          {"normalised.onnx: makes something else of its recorded sample"});
  refuses("in", kNetworks / "sorting.onnx", 1, {"OpenCV does not run its operator TopK"});
  refuses("small", kNetworks / "fine.onnx", 2, {"frames of 31x40 px: are smaller than the 32x32 px"});
  fs::resize_file(Copied("short.safetensors"), fs::file_size(kShipped) - 1000);
  refuses("in", "short.safetensors", 1, {"short.safetensors: "});
  // The card is text in the file: its sizes with another name, of the same length.
  for (const auto& [from, to] :
       {std::pair("\\\"tile\\\"", "\\\"tale\\\""), std::pair("\\\"width\\\"", "\\\"witdh\\\"")}) {
    std::string bytes = ReadText(Copied("card.safetensors"));
    ASSERT_NE(bytes.find(from), std::string::npos);
    folder_.Put("card.safetensors", bytes.replace(bytes.find(from), std::string(from).size(), to));
    refuses("in", "card.safetensors", 1, {"card.safetensors: the model card's ", " is missing"});
  }
  const Ran both = Restore("in", "out", {"--model", "x.onnx", "--no-sharpen"});
  EXPECT_EQ(both.exit_code, 2);
}

}  // namespace
}  // namespace shimmer::restore::app
