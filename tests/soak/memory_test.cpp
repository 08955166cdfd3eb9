// Memory stays flat, however many clips a run makes.
#include <cmath>

#include "tests/app/sets.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

// What a process has in memory now; 0 once it is gone.
int64_t MemoryOf(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::atoll(line.c_str() + 6) * 1024;
  return 0;
}

size_t LinesIn(std::ifstream& file, size_t lines) {
  file.clear();
  for (std::string line; std::getline(file, line);) ++lines;
  return lines;
}

TEST(SoakMemory, StaysFlatOverTenThousandClips) {
  const TempFolder folder;
  for (uint32_t i = 0; i < 20; ++i)
    WritePng(folder, "in/" + std::to_string(i) + ".png", dataset::RandomImage({320, 240}, 3, i));
  folder.Put("c.json", SmallConfig({{"clips", 10'000}, {"size", {64, 64}}, {"source", {{"images", "in"}}}}));
  Running run(folder.path(), {"generate", "c.json", "--out", "set", "--quiet"});
  const fs::path manifest = folder / "set/manifest.jsonl";
  WaitUntil([&] { return fs::exists(manifest); });
  std::ifstream file(manifest);
  size_t clips = 0;
  int64_t after_500 = 0, most_later = 0, last = 0;
  int samples = 0;
  while (const int64_t memory = MemoryOf(run.pid())) {
    clips = LinesIn(file, clips);
    if (clips >= 500) {
      if (after_500 == 0) after_500 = memory;
      most_later = std::max(most_later, memory);
      last = memory;
      ++samples;
    }
    if (clips >= 10'000) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const Ran ran = run.Wait();
  ExpectDone(ran);
  ASSERT_GT(samples, 10);
  const double growth = static_cast<double>(most_later) / static_cast<double>(after_500) - 1;
  EXPECT_LT(growth, 0.05);
  Tell("memory, 10000 clips of 2 frames of 64 x 64: " + std::to_string(after_500 >> 20) + " MiB after 500, " +
       std::to_string(last >> 20) + " MiB at the end, growth at the most " +
       std::to_string(std::lround(growth * 1000) / 10.0).substr(0, 4) + " % (" + std::to_string(samples) +
       " samples)");
}

}  // namespace
}  // namespace shimmer::app
