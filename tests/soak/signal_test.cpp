// Fault 2: asked to stop at any moment, it does so soon and in good order, and goes on to the same set.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// How long programs took from the signal to their end.
class StopTimes {
 public:
  void Add(double seconds) { seconds_.push_back(seconds); }
  void Check(const std::string& what) {
    ASSERT_FALSE(seconds_.empty());
    std::ranges::sort(seconds_);
    if (InSoak()) {
      EXPECT_LT(seconds_.back(), 2);
    }
    const auto ms = [](double seconds) { return std::to_string(std::lround(seconds * 1000)) + " ms"; };
    Tell("2 signal, " + what + ": " + std::to_string(seconds_.size()) + " signals; from signal to exit " +
         ms(seconds_[seconds_.size() / 2]) + " in the middle, " + ms(seconds_.back()) + " at the most");
  }

 private:
  std::vector<double> seconds_;
};

class Signals : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Layouts, Signals, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return info.param; });

TEST_P(Signals, EndARunInGoodOrder) {
  const TempFolder folder;
  folder.Put("c.json", SetConfig(GetParam(), Times(40, 200),
                                 {{"size", {96, 64}}, {"blur", {{"max_sigma_px", 4}, {"method", "exact"}}}}));
  const auto begun = Clock::now();
  ExpectDone(Shimmer(folder, GenerateWords("c.json", "whole")));
  const double whole_seconds = SecondsSince(begun);
  const auto whole = WholeTree(folder / "whole");

  std::mt19937 generator(2);
  std::uniform_real_distribution<double> moment(0, whole_seconds);
  StopTimes times;
  const fs::path set = folder / "set";
  for (int stop = 0; stop < Times(4, 50); ++stop) {
    fs::remove_all(set);
    const int signal = stop % 2 == 0 ? SIGTERM : SIGINT;
    Running run(folder.path(), GenerateWords("c.json", "set"));
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(generator)));
    const auto asked = Clock::now();
    run.Signal(signal);
    const Ran ran = run.Wait();
    EXPECT_EQ(ran.err, "");
    if (!fs::exists(set)) {  // perhaps it had not begun to listen
      EXPECT_TRUE(ran.exit_code == 130 || ran.exit_code == 128 + signal) << ran.exit_code;
      continue;
    }
    times.Add(SecondsSince(asked));
    EXPECT_TRUE(ran.exit_code == 130 || ran.exit_code == 0) << ran.exit_code;
    EXPECT_FALSE(fs::exists(set / ".staging"));
    EXPECT_EQ(BrokenFiles(set), Words());
    ExpectDone(RunForked(folder, GenerateWords("c.json", "set")));
    EXPECT_EQ(Differing(whole, WholeTree(set)), Words());
  }
  times.Check(GetParam());
}

// The signal has a handler in that process by now.
bool Catches(pid_t pid, int signal) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (const std::string key = "SigCgt:"; line.starts_with(key))
      return (std::stoull(line.substr(key.size()), nullptr, 16) >> (signal - 1) & 1) != 0;
  return false;
}

// Other things that take their time: reading sources to the end, waiting for another process.
TEST(SignalsElsewhere, EndWhatIsNoClip) {
  const TempFolder folder;
  std::ofstream(folder / "large.png").put('x');
  fs::resize_file(folder / "large.png", uintmax_t{8} << 30);  // a hole: it takes no memory, but is read
  folder.Put("hash.json", SmallConfig({{"source", {{"images", "large.png"}}}}));
  folder.Put("c.json", SmallConfig());
  const dataset::DatasetWriter holder(folder / "held", dataset::Layout(), {{"config", Json::object()}});
  StopTimes times;
  for (const Words& words : {GenerateWords("hash.json", "set"), GenerateWords("c.json", "held", {"--wait"})})
    for (int stop = 0; stop < Times(1, 10); ++stop) {
      Running run(folder.path(), words);
      WaitUntil([&] { return Catches(run.pid(), SIGTERM); });
      std::this_thread::sleep_for(std::chrono::milliseconds(200));  // well into it
      const auto asked = Clock::now();
      run.Signal(SIGTERM);
      const Ran ran = run.Wait();
      EXPECT_EQ(ran.exit_code, 130) << ran.err;
      EXPECT_EQ(ran.err, "");
      times.Add(SecondsSince(asked));
    }
  EXPECT_FALSE(fs::exists(folder / "set"));
  times.Check("hashing and waiting");
}

}  // namespace
}  // namespace shimmer::app
