#include "sim/app/clip_size.h"

#include <algorithm>
#include <set>
#include <span>

#include "sim/app/config/distribution.h"
#include "sim/app/job.h"
#include "sim/dataset/layout.h"
#include "sim/dataset/tar.h"

namespace shimmer::app {
namespace {

// A file of so many samples, compressed as badly as it gets: a hundredth and its headers more than they take.
int64_t MostFileBytes(int64_t samples_bytes) {
  return dataset::TarBytes(samples_bytes + samples_bytes / 100 + 4096);
}

int64_t Pixels(cv::Size size) { return static_cast<int64_t>(size.width) * size.height; }

// Of a frame, by the kinds of files that are written of it.
int64_t TruthBytes(std::span<const std::string> truth, int64_t pixels) {
  const std::set<dataset::FrameKind> kinds = dataset::TruthKinds(truth);
  int64_t bytes = 0;
  if (kinds.contains(dataset::FrameKind::kTruth)) bytes += MostFileBytes(pixels * 3 * 4);
  if (kinds.contains(dataset::FrameKind::kMask)) bytes += MostFileBytes(pixels);
  if (kinds.contains(dataset::FrameKind::kFlow)) bytes += MostFileBytes(pixels * 2 * 4);
  if (kinds.contains(dataset::FrameKind::kShake)) bytes += MostFileBytes(64);
  return bytes;
}

// The farthest that a camera may be off its place, whatever is drawn.
int MostReach_px(const ConfigFile& config) {
  const Json& camera = config.resolved().at("camera");
  sim::CameraParams most = config.fixed().camera;
  most.amplitude_px = LargestOf(camera.at("amplitude_px"));
  most.bound_px = LargestOf(camera.at("bound_px"));
  int reach_px = 0;
  for (size_t i = 0; i < sim::kShakeNames.size(); ++i) {
    most.shake = static_cast<sim::Shake>(i);
    if (!MayBe(camera.at("shake"), sim::kShakeNames[i])) continue;
    const cv::Size reach = sim::ShakeReach(most);
    reach_px = std::max({reach_px, reach.width, reach.height});
  }
  return reach_px;
}

}  // namespace

int64_t ClipsPerTar(const ConfigFile& config, bool one_clean) {
  constexpr int64_t kJson_bytes = 1 << 16, kMB = 1'000'000;
  const Config& fixed = config.fixed();
  const int64_t pixels = Pixels(config.LargestSize()), frames = fixed.frames,
                picture_bytes = MostFileBytes(pixels * 3 * fixed.output.bits / 8),
                truth_bytes = TruthBytes(fixed.output.truth, pixels);
  const int64_t clip_bytes =
      frames * (picture_bytes + truth_bytes) + (one_clean ? 1 : frames) * picture_bytes + kJson_bytes;
  return std::max<int64_t>(1, (fixed.output.tar_mb * kMB - dataset::kTarEndBytes) / clip_bytes);
}

MemoryPlan PlanMemory(int64_t budget_bytes, const ConfigFile& config, int threads) {
  // Measured (docs/performance.md): the program and its libraries; a clip's frame in the making with its
  // surroundings, the clean frame, its samples and their files.
  constexpr int64_t kProgram_bytes = 200'000'000, kPixel_bytes = 110, kMovingPixel_bytes = 40;
  const bool moves = !config.fixed().objects.empty();
  const int surroundings_px = 2 * (48 + MostReach_px(config));
  const cv::Size size = config.LargestSize();
  const int64_t clip_bytes = Pixels({size.width + surroundings_px, size.height + surroundings_px}) *
                             (kPixel_bytes + (moves ? kMovingPixel_bytes : 0));
  const bool has_cutouts = std::ranges::any_of(
      config.fixed().objects, [](const ObjectParams& object) { return !object.images.empty(); });
  const int64_t free_bytes =
      std::max<int64_t>(0, budget_bytes - kProgram_bytes - (has_cutouts ? kCutoutMemory_bytes : 0));
  // A quarter is for sources at least: reading one anew for each clip costs more than a thread brings.
  const int at_once = static_cast<int>(std::clamp<int64_t>(free_bytes * 3 / 4 / clip_bytes, 1, threads));
  return {.sources_bytes = std::max<int64_t>(0, free_bytes - at_once * clip_bytes), .clips_at_once = at_once};
}

}  // namespace shimmer::app
