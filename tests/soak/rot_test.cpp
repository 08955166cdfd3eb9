// Fault 14: silent rot, done to hundreds of files at random, is found to the last one and undone.
#include "tests/app/harm.h"
#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

struct Stored {
  std::string layout, format;
};

class Rot : public testing::TestWithParam<Stored> {};
INSTANTIATE_TEST_SUITE_P(Sets, Rot,
                         testing::Values(Stored{"sequence", "png"}, Stored{"sequence", "exr"},
                                         Stored{"pairs", "png"}, Stored{"restormer", "png"},
                                         Stored{"basicsr", "exr"}),
                         [](const auto& info) { return info.param.layout + "_" + info.param.format; });

TEST_P(Rot, IsFoundToTheLastFileAndUndone) {
  const TempFolder folder;
  folder.Put("c.json",
             SetConfig(GetParam().layout, Times(40, 400), {{"output", {{"format", GetParam().format}}}}));
  ExpectDone(Shimmer(folder, GenerateWords("c.json", "set")));
  Harm harm(folder / "set", 14);
  harm.Do({.flipped = Times(50, 500),
           .deleted = Times(5, 50),
           .swapped_pairs = Times(3, 25),
           .truncated = Times(5, 50)});
  const Ran found = Shimmer(folder, {"verify", "set"});
  harm.ExpectFound(found);
  ExpectDone(Shimmer(folder, {"verify", "set", "--repair", "--quiet"}));
  harm.ExpectUndone();
  Tell("14 rot, " + GetParam().layout + " of " + GetParam().format + ": " + std::to_string(harm.size()) +
       " of " + std::to_string(harm.size()) + " files found, all undone, no other file touched");
}

}  // namespace
}  // namespace shimmer::app
