// Restoration with another flow than OpenCV's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "restore/app/frame_source.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/torch/networks.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore::app {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

const cv::Size kSize(160, 128);
const cv::Rect kBright(64, 40, 40, 48);

// A scene through turbulence, in 0.1 to 0.5 of white, and in a part of it that stands as all of it does, in
// 0.7 to 1.
void PutScene(const TempFolder& folder, const std::string& name, uint32_t frames = 12) {
  for (uint32_t k = 0; k < frames; ++k) {
    cv::Mat frame = SeenFrame({.size = kSize, .tilt_rms_px = 0.5, .frame = k, .gain = 0.5});
    frame = cv::min(cv::max(frame - 0.2, 0.1), 0.5);
    frame(kBright) = frame(kBright) * 0.75 + 0.6;
    folder.Put(name + "/" + std::to_string(1000 + k) + ".png", dataset::EncodePng(frame, 8));
  }
}

Ran Restored(const TempFolder& folder, const std::string& out, const Words& more) {
  Words words = {"restore", "in", "--out", out, "--stages", out + ".stages", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return Unshimmer(folder, words);
}

TEST(RestoreFlow, DisIsTheDefault) {
  const TempFolder folder;
  PutScene(folder, "in");
  ExpectDone(Restored(folder, "named", {"--flow", "dis"}));
  ExpectDone(Restored(folder, "default", {}));
  EXPECT_EQ(dataset::Tree(folder / "named"), dataset::Tree(folder / "default"));
}

// The program alone, as builds without torch have it.
TEST(RestoreFlow, WithoutTorchANetworkIsRefused) {
  const TempFolder folder;
  PutScene(folder, "in", 2);
  fs::copy(UNSHIMMER_PROGRAM, folder / "unshimmer");
  const std::string program = (folder / "unshimmer").string();
  for (const Words& words : {Words{"plan", "in", "--flow", "raft.pt", "--quiet"},
                             Words{"restore", "in", "--flow", "raft.pt", "--out", "out", "--quiet"}}) {
    const Ran ran = shimmer::app::Running(folder.path(), words, false, program.c_str()).Wait();
    ExpectRefused(ran, 2,
                  {"raft.pt: this build has no TorchScript, must be dis, or a build with "
                   "-DSHIMMER_TORCH=ON and Debian's libtorch-dev (scripts/setup.sh --torch)"});
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

class RestoreByNetwork : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(UNSHIMMER_PROGRAM).parent_path() / "libshimmer_torch.so"))
      GTEST_SKIP() << "built without SHIMMER_TORCH";
    if (!Networks::CanBeMade()) GTEST_SKIP() << kNoPyTorch;
    networks_.emplace();
  }
  std::string Path(const std::string& name) const { return (*networks_)[name].string(); }

  TempFolder folder_;
  std::optional<Networks> networks_;
};

// Nothing moves, but the network says that what is bright does.
TEST_F(RestoreByNetwork, MasksAreTheNetworks) {
  PutScene(folder_, "in");
  for (const char* threads : {"1", "3"})
    ExpectDone(Restored(folder_, std::string("out") + threads,
                        {"--segment", "aof", "--flow", Path("Bright"), "--threads", threads}));
  EXPECT_EQ(dataset::Tree(folder_ / "out1.stages"), dataset::Tree(folder_ / "out3.stages"));
  const auto masks = OpenFrames(folder_ / "out1.stages/mask");
  ASSERT_EQ(masks->count(), 12);
  cv::Mat bright = cv::Mat::zeros(kSize, CV_8UC1);
  bright(kBright).setTo(255);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(cv::norm(masks->Read(k).pixels, bright, cv::NORM_INF), 0) << k;
  // By DIS all of it stands, or is as unsure as turbulence is.
  ExpectDone(Restored(folder_, "dis", {"--segment", "aof"}));
  EXPECT_NE(dataset::Tree(folder_ / "dis.stages/mask"), dataset::Tree(folder_ / "out1.stages/mask"));
  const Ran plan = Unshimmer(folder_, {"plan", "in", "--flow", Path("Bright"), "--quiet"});
  ExpectDone(plan);
  EXPECT_THAT(plan.out, HasSubstr("stages    "));
}

TEST_F(RestoreByNetwork, RefusesWhatIsNoneInOneLine) {
  PutScene(folder_, "in", 2);
  for (const char* name : {"Cut", "Text", "NotFinite"})
    ExpectRefused(Restored(folder_, "out", {"--flow", Path(name)}), 1, {std::string(name) + ".pt: "});
  ExpectRefused(Restored(folder_, "out", {"--flow", "nowhere.pt"}), 1, {"nowhere.pt: is not there"});
  ExpectRefused(Restored(folder_, "out", {"--flow", "in"}), 1, {"in: is not there, must be dis or the file"});
  for (const char* name : {"out", "out.part", "out.stages"}) EXPECT_FALSE(fs::exists(folder_ / name)) << name;
}

}  // namespace
}  // namespace shimmer::restore::app
