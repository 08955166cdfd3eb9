// Fault 4: system calls that fail, each in its turn. A run in which one did either makes the whole set or
// says what went wrong and where, and never leaves anything that the next run does not put right.
#include <algorithm>
#include <cstring>
#include <ranges>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

struct Case {
  const char* name;
  int error;
  const char* mode;
  bool invisible;  // the run must make the set as if nothing had been
  const char* calls = "all";
};

class FailingCalls : public testing::TestWithParam<Case> {
 protected:
  // A set of each layout, as it comes out where nothing fails, in whole/LAYOUT.
  void SetUp() override {
    for (const std::string& layout : kLayouts) {
      folder_.Put(layout + ".json", SetConfig(layout, 6));
      FaultyRun run(folder_.path(), Command(layout, "whole/" + layout),
                    {.root = folder_ / "whole", .calls = GetParam().calls});
      ExpectDone(run.Wait());
      calls_[layout] = run.calls();
      whole_[layout] = WholeTree(folder_ / ("whole/" + layout));
    }
  }
  static Words Command(const std::string& layout, const std::string& out) {
    return GenerateWords(layout + ".json", out);
  }

  void FailCall(const std::string& layout, int64_t call) {
    const fs::path set = folder_ / "set";
    fs::remove_all(set);
    const auto [name, error, mode, invisible, calls] = GetParam();
    const std::string where = layout + ", call " + std::to_string(call);
    const Ran ran = RunForked(folder_, Command(layout, "set"),
                              {.root = set, .calls = calls, .mode = mode, .at = call, .error = error});
    if (invisible)
      EXPECT_EQ(ran.exit_code, 0) << where << ": " << ran.err;
    else if (ran.exit_code != 0)
      ExpectOneLine(ran, 1, {"set"});
    if (fs::exists(set)) {
      EXPECT_EQ(BrokenFiles(set), Words()) << where;
    }
    if (ran.exit_code == 0) {
      auto tree = WholeTree(set);
      // Where a folder can't be opened it can't be emptied either.
      std::erase_if(tree, [](const auto& file) { return file.first.starts_with(".staging"); });
      EXPECT_EQ(Differing(whole_[layout], tree), Words()) << where;
    }
    failed_ += ran.exit_code != 0;
    const Ran again = RunForked(folder_, Command(layout, "set"));
    EXPECT_EQ(again.exit_code, 0) << where << ": " << ran.err << again.err;
    EXPECT_EQ(Differing(whole_[layout], WholeTree(set)), Words()) << where << ": " << ran.err;
  }

  TempFolder folder_;
  std::map<std::string, std::map<std::string, std::string>> whole_;
  std::map<std::string, int64_t> calls_;
  int failed_ = 0;
};

// Without those that remove files: what can be taken away after an error must be the right thing.
constexpr const char* kMaking =
    "write,pwrite,writev,fsync,fdatasync,syncfs,rename,link,open,close,mkdir,ftruncate,flock";
// What Linux says of EINTR: the calls that a signal may interrupt.
constexpr const char* kInterruptible =
    "write,pwrite,writev,fsync,fdatasync,syncfs,open,close,ftruncate,flock";
INSTANTIATE_TEST_SUITE_P(Errors, FailingCalls,
                         testing::Values(Case{"IoErrorOnce", EIO, "once", false},
                                         Case{"IoErrorFromThere", EIO, "persistent", false, kMaking},
                                         Case{"NoSpaceOnce", ENOSPC, "once", false},
                                         Case{"NoSpaceFromThere", ENOSPC, "persistent", false, kMaking},
                                         Case{"QuotaOnce", EDQUOT, "once", false},
                                         Case{"QuotaFromThere", EDQUOT, "persistent", false, kMaking},
                                         Case{"NoDescriptorsOnce", EMFILE, "once", false},
                                         Case{"NoDescriptorsFromThere", EMFILE, "persistent", false, kMaking},
                                         Case{"InterruptedOnce", EINTR, "once", true, kInterruptible},
                                         Case{"InterruptedEverySecond", EINTR, "alternate", true,
                                              kInterruptible},
                                         Case{"ShortWrites", 0, "short", true, "write,pwrite,writev"}),
                         [](const auto& info) { return info.param.name; });

// From the first call to the last, each in one of the layouts; over the cases, in all of them.
TEST_P(FailingCalls, GiveTheWholeSetOrAnErrorAndTheNextRunTheSet) {
  const int tries = Times(10, 300);
  const auto shift = static_cast<size_t>(GetParam().error + std::strlen(GetParam().mode));
  for (int i = 0; i < tries; ++i) {
    const std::string& layout = kLayouts[(static_cast<size_t>(i) + shift) % kLayouts.size()];
    FailCall(layout, 1 + i * calls_[layout] / tries);
  }
  Tell(std::string("4 failing calls, ") + GetParam().name + ": " + std::to_string(tries) + " runs of " +
       std::to_string(std::ranges::min(calls_ | std::views::values)) + " to " +
       std::to_string(std::ranges::max(calls_ | std::views::values)) + " calls, " + std::to_string(failed_) +
       " ended with an error, no bad set; all equal after the next run");
}

}  // namespace
}  // namespace shimmer::app
