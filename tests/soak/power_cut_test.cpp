// Fault 5: the power goes. Whatever the disk may hold then (power_cut.h), what the manifest names is whole,
// and the run goes on from there to the same set.
#include "tests/soak/power_cut.h"

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

class PowerCuts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Layouts, PowerCuts, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return info.param; });

std::string BrokenOrUnreadable(const fs::path& set) {
  try {
    const Words broken = BrokenFiles(set);
    return broken.empty() ? "" : broken.front();
  } catch (const std::exception& error) {
    return error.what();
  }
}

// What a run has written down of itself, in a folder of that name.
std::string LogOfRun(const TempFolder& folder, int clips, const std::string& layout) {
  folder.Put("c.json", SetConfig(layout, clips));
  fs::create_directory(folder / "disk");
  ExpectDone(RunForked(folder, GenerateWords("c.json", "disk/set"),
                       {.root = folder / "disk", .log = folder / "log"}));
  return ReadText(folder / "log");
}

TEST_P(PowerCuts, LeaveWhatTheManifestNamesWhole) {
  const TempFolder folder;
  const std::string log = LogOfRun(folder, Times(40, 120), GetParam());
  const fs::path set = folder / "disk/set";
  const auto whole = WholeTree(set);
  const PowerCut power(log, folder / "disk");
  const auto cuts = static_cast<size_t>(Times(10, 100));
  const std::vector<size_t> syncs = power.Syncs();
  size_t clips = 0;
  for (size_t cut = 1; cut <= cuts; ++cut) {
    // Half of them beside a sync: of a group's many changes only few are near one.
    const size_t changes =
        cut % 2 == 0 ? cut * power.changes() / cuts : syncs.at((cut - 1) * syncs.size() / cuts);
    power.Rebuild(changes, static_cast<uint32_t>(cut), folder / "disk");
    const std::string where =
        "after " + std::to_string(changes) + " changes of " + std::to_string(power.changes());
    if (fs::exists(set)) {
      EXPECT_EQ(BrokenOrUnreadable(set), "") << where;
      clips += DoneClips(set).size();
    }
    const Ran ran = RunForked(folder, GenerateWords("c.json", "disk/set"));
    EXPECT_EQ(ran.exit_code, 0) << where << ": " << ran.err;
    EXPECT_EQ(Differing(whole, WholeTree(set)), Words()) << where;
  }
  EXPECT_GT(clips, 0u);
  Tell("5 power cut, " + GetParam() + ": " + std::to_string(cuts) + " cuts, all sets equal; " +
       std::to_string(clips) + " clips survived and were whole");
}

// The model itself: with all of it synced it gives the tree that was there.
TEST_P(PowerCuts, OfADiskThatHasSyncedAllLoseNothing) {
  const TempFolder folder;
  const std::string log = LogOfRun(folder, 10, GetParam());
  const auto whole = WholeTree(folder / "disk");
  const PowerCut power(log + "syncfs\t" + (folder / "disk").string() + "\t0\n", folder / "disk");
  for (uint32_t seed = 0; seed < 3; ++seed) {
    power.Rebuild(power.changes(), seed, folder / "rebuilt");
    EXPECT_EQ(Differing(whole, WholeTree(folder / "rebuilt")), Words());
  }
}

// And it would find a program that does not sync: of one whose syncs are left out, sets come out broken.
TEST_P(PowerCuts, OfADiskThatSyncsNothingLoseFiles) {
  const TempFolder folder;
  std::string log = LogOfRun(folder, 10, GetParam());
  for (size_t at = 0; (at = log.find("\nsync", at)) != std::string::npos;)
    log.erase(at, log.find('\n', at + 1) - at);
  const PowerCut power(log, folder / "disk");
  int broken = 0;
  for (uint32_t seed = 0; seed < 30; ++seed) {
    power.Rebuild(power.changes(), seed, folder / "disk");
    broken += fs::exists(folder / "disk/set") && !BrokenOrUnreadable(folder / "disk/set").empty();
  }
  EXPECT_GT(broken, 0);
}

}  // namespace
}  // namespace shimmer::app
