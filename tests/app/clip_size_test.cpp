#include "sim/app/clip_size.h"

#include <gtest/gtest.h>

#include "sim/app/job.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

constexpr int64_t kMB = 1'000'000;

MemoryPlan PlanFor(const std::string& rest, int64_t budget_bytes = 1000 * kMB, int threads = 64) {
  return PlanMemory(budget_bytes, ConfigFile::Parse(WithSource(R"("size": [512, 512], )" + rest)), threads);
}

int ClipsAtOnce(const std::string& rest) { return PlanFor(rest).clips_at_once; }

TEST(PlanMemory, HasAClipAThreadAndOneAtLeast) {
  EXPECT_EQ(PlanFor(R"("seed": 1)", 1000 * kMB, 2).clips_at_once, 2);
  EXPECT_EQ(PlanFor(R"("seed": 1)", 0, 2).clips_at_once, 1);
  EXPECT_EQ(PlanFor(R"("seed": 1)", 0, 2).sources_bytes, 0);
}

// A camera that may go further takes more of the source, whichever way it is said.
TEST(PlanMemory, CountsTheFarthestShake) {
  const int standing = ClipsAtOnce(R"("seed": 1)");
  const std::string far = R"("amplitude_px": 60, "bound_px": 120)";
  const int shaken = ClipsAtOnce(R"("camera": {"shake": "walk", )" + far + "}");
  EXPECT_LT(shaken, standing);
  EXPECT_EQ(ClipsAtOnce(R"("camera": {"shake": {"choice": ["none", "walk"]}, )" + far + "}"), shaken);
  EXPECT_EQ(ClipsAtOnce(R"("camera": {"shake": {"choice": ["none", "vibration"]}, "amplitude_px": 60})"),
            shaken);
  EXPECT_EQ(ClipsAtOnce(R"("camera": {"shake": "drift", "bound_px": {"uniform": [3, 120]}})"), shaken);
  EXPECT_EQ(ClipsAtOnce(R"("frames": 2, "camera": {"shake": "list", "shifts": [[0, 0], [120, 3]]})"), shaken);
  EXPECT_EQ(ClipsAtOnce(R"("camera": {"shake": "none", )" + far + "}"), standing);
}

TEST(PlanMemory, CountsObjectsAndTheirPictures) {
  const MemoryPlan plain = PlanFor(R"("seed": 1)", 1000 * kMB, 1),
                   drawn = PlanFor(R"("objects": [{"drawn": "disc"}])", 1000 * kMB, 1),
                   pictures = PlanFor(R"("objects": [{"images": "cut"}])", 1000 * kMB, 1);
  EXPECT_LT(drawn.sources_bytes, plain.sources_bytes);
  EXPECT_EQ(pictures.sources_bytes, drawn.sources_bytes - kCutoutMemory_bytes);
}

TEST(CutoutMemory, ReadsOnceAndForgetsTheOldest) {
  int reads = 0;
  const auto read = [&] {
    ++reads;
    return std::make_shared<const sim::Cutout>(cv::Mat(8, 8, CV_32FC4, cv::Scalar::all(1)));
  };
  const int64_t one_bytes = read()->bytes();
  EXPECT_GT(one_bytes, 8 * 8 * 16);
  CutoutMemory memory(2 * one_bytes);
  reads = 0;
  const auto first = memory.Get("a", read);
  EXPECT_EQ(memory.Get("a", read), first);
  memory.Get("b", read);
  memory.Get("a", read);
  EXPECT_EQ(reads, 2);
  memory.Get("c", read);  // "b" goes
  EXPECT_EQ(memory.Get("a", read), first);
  EXPECT_EQ(reads, 3);
  memory.Get("b", read);
  EXPECT_EQ(reads, 4);
  CutoutMemory none(0);
  EXPECT_NE(none.Get("a", read), none.Get("a", read));
}

}  // namespace
}  // namespace shimmer::app
