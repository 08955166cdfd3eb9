// Fault 1 of verify --repair: killed at any moment, the next one undoes the rest of the harm.
#include "tests/app/harm.h"
#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

struct Harmed {
  std::string layout;
  HarmCounts counts;
};

class KilledRepair : public testing::TestWithParam<Harmed> {};
INSTANTIATE_TEST_SUITE_P(
    Layouts, KilledRepair,
    testing::Values(Harmed{"sequence", {.flipped = 5, .deleted = 3, .swapped_pairs = 2, .surplus = 3}},
                    Harmed{"pairs", {.flipped = 5, .deleted = 3, .swapped_pairs = 2, .surplus = 3}},
                    Harmed{"webdataset", {.flipped = 1, .deleted = 1, .truncated = 1, .surplus = 2}}),
    [](const auto& info) { return info.param.layout; });

TEST_P(KilledRepair, IsFinishedByTheNext) {
  const TempFolder folder;
  folder.Put("c.json", SetConfig(GetParam().layout, 30));
  ExpectDone(Shimmer(folder, GenerateWords("c.json", "whole")));
  const auto harm_copy = [&](uint32_t seed) {
    fs::remove_all(folder / "set");
    fs::copy(folder / "whole", folder / "set", fs::copy_options::recursive);
    Harm harm(folder / "set", seed);
    harm.Do(GetParam().counts);
    return harm;
  };
  const Words repair = {"verify", "set", "--repair", "--quiet"};
  const Harm harm = harm_copy(0);
  FaultyRun unkilled(folder.path(), repair, {.root = folder / "set"});
  EXPECT_EQ(unkilled.Wait().exit_code, 0);
  harm.ExpectUndone();

  const int kills = Times(6, 60);
  for (int kill = 0; kill < kills; ++kill) {
    const Harm again = harm_copy(static_cast<uint32_t>(kill));
    FaultyRun run(folder.path(), repair,
                  {.root = folder / "set", .mode = "kill", .at = 1 + kill * unkilled.calls() / kills});
    run.Wait();
    EXPECT_EQ(Shimmer(folder, repair).exit_code, 0) << "kill " << kill;
    again.ExpectUndone();
  }
  Tell("1 kill of repair, " + GetParam().layout + ": " + std::to_string(kills) + " kills of " +
       std::to_string(unkilled.calls()) + " calls, all sets as they were");
}

}  // namespace
}  // namespace shimmer::app
