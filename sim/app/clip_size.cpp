#include "sim/app/clip_size.h"

#include <algorithm>

#include "sim/dataset/tar.h"

namespace shimmer::app {
namespace {

// A file of so many samples, compressed as badly as it gets: a hundredth and its headers more than they take.
int64_t MostFileBytes(int64_t samples_bytes) {
  return dataset::TarBytes(samples_bytes + samples_bytes / 100 + 4096);
}

int64_t Pixels(cv::Size size) { return static_cast<int64_t>(size.width) * size.height; }

}  // namespace

int64_t ClipsPerTar(const ConfigFile& config, bool still) {
  constexpr int64_t kJson_bytes = 1 << 16, kMB = 1'000'000;
  const Config& fixed = config.fixed();
  const int64_t pixels = Pixels(config.LargestSize()), frames = fixed.frames,
                picture_bytes = MostFileBytes(pixels * 3 * fixed.output.bits / 8),
                truth_bytes = fixed.output.truth.empty() ? 0 : MostFileBytes(pixels * 3 * 4);
  const int64_t clip_bytes =
      frames * (picture_bytes + truth_bytes) + (still ? 1 : frames) * picture_bytes + kJson_bytes;
  return std::max<int64_t>(1, (fixed.output.tar_mb * kMB - dataset::kTarEndBytes) / clip_bytes);
}

MemoryPlan PlanMemory(int64_t budget_bytes, const ConfigFile& config, int threads) {
  // Measured (docs/performance.md): the program and its libraries; a clip's frame in the making with its
  // surroundings, the clean frame, its samples and their files.
  constexpr int64_t kProgram_bytes = 200'000'000, kPixel_bytes = 110;
  constexpr int kSurroundings_px = 2 * 48;
  const cv::Size size = config.LargestSize();
  const int64_t clip_bytes =
      Pixels({size.width + kSurroundings_px, size.height + kSurroundings_px}) * kPixel_bytes;
  const int64_t free_bytes = std::max<int64_t>(0, budget_bytes - kProgram_bytes);
  // A quarter is for sources at least: reading one anew for each clip costs more than a thread brings.
  const int at_once = static_cast<int>(std::clamp<int64_t>(free_bytes * 3 / 4 / clip_bytes, 1, threads));
  return {.sources_bytes = std::max<int64_t>(0, free_bytes - at_once * clip_bytes), .clips_at_once = at_once};
}

}  // namespace shimmer::app
