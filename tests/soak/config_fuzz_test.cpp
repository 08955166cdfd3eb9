// Fault 10: damaged configs, as many as it takes, and large and strange ones.
#include <sys/resource.h>

#include "tests/app/config_damage.h"
#include "tests/app/config_errors.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

// What is wrong with how a config was refused, or "".
std::string Fault(const ConfigError& error) {
  const std::string message = error.what();
  if (message.empty() || (error.pointer() + message).find('\n') != std::string::npos || message.size() > 400)
    return "no good message: " + error.pointer() + ": " + message;
  return "";
}

// Returns the number of configs that were refused; prints what is wrong.
int64_t ReadDamaged(int configs) {
  using Clock = std::chrono::steady_clock;
  Damage damage(10);
  int64_t refused = 0;
  for (int i = 0; i < configs; ++i) {
    const std::string text = damage.Apply(kFullConfig);
    const auto start = Clock::now();
    try {
      const ConfigFile file = ConfigFile::Parse(text);
      if (file.Hash() != ConfigFile::Parse(file.resolved().dump()).Hash())
        std::printf("not the same again: %s\n", text.c_str());
      file.Draw(damage.Below(1000), nullptr);
    } catch (const ConfigError& error) {
      ++refused;
      if (const std::string fault = Fault(error); !fault.empty()) std::printf("%s\n", fault.c_str());
    }
    if (Clock::now() - start > std::chrono::seconds(2)) std::printf("config %d took too long\n", i);
  }
  return refused;
}

#ifndef __SANITIZE_ADDRESS__
// Half a GiB more than it has.
void LimitMemory() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  const rlim_t most = pages * 4096 + (rlim_t{512} << 20);
  const rlimit limit = {most, most};
  setrlimit(RLIMIT_AS, &limit);
}
#else
void LimitMemory() {}  // shadow memory is not ours
#endif

TEST(DamagedConfigs, AreReadOrRefusedWithinTimeAndMemory) {
  const TempFolder folder;
  const int configs = Times(500, 10'000);
  Running reader(folder.path(), [&] {
    LimitMemory();
    std::fprintf(stderr, "%lld", static_cast<long long>(ReadDamaged(configs)));
    return 0;
  });
  const Ran ran = reader.Wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out, "");
  Tell("10 configs: " + std::to_string(configs) + " damaged, " + ran.err +
       " refused, 0 crashes, each within 2 s and 512 MiB");
}

std::string Utf16(const std::string& text, bool big_endian) {
  std::string wide = big_endian ? "\xfe\xff" : "\xff\xfe";
  for (const char c : text) wide += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return wide;
}

// As some editors write it.
TEST(DamagedConfigs, AByteOrderMarkIsNoFault) {
  const TempFolder folder;
  folder.Put("c.json", "\xef\xbb\xbf" + SmallConfig());
  EXPECT_EQ(RunForked(folder, {"generate", "c.json", "--out", "set", "--quiet"}).exit_code, 0);
}

// Through the program: one line that names the file, exit code 2, nothing made.
TEST(DamagedConfigs, ThatAreLargeOrStrangeAreRefused) {
  const size_t large = InSoak() ? 100'000'000 : 1'000'000;
  const std::string good = SmallConfig(), open = good.substr(0, good.size() - 1);
  const std::vector<std::pair<const char*, std::string>> configs = {
      {"UTF-16", Utf16(good, false)},
      {"UTF-16 the other way round", Utf16(good, true)},
      {"zero bytes", good + std::string(10, '\0')},
      {"nothing but zero bytes", std::string(1000, '\0')},
      {"deep lists", std::string(large / 10, '[')},
      {"deep objects",
       [&] {
         std::string text;
         for (size_t i = 0; i < large / 100; ++i) text += "{\"a\":";
         return text;
       }()},
      {"a long text", open + R"(,"output":{"name":")" + std::string(large, 'x') + "\"}}"},
      {"a long key", open + ",\"" + std::string(large, 'x') + "\":1}"},
      {"a long number", open + ",\"seed\":" + std::string(large / 10, '1') + "}"},
      {"a key twice", open + R"(,"frames":3})"},
      {"a range the wrong way round", open + R"(,"tilt":{"strength_px":{"uniform":[5,1]}}})"},
      {"text that is no UTF-8", open + ",\"output\":{\"name\":\"\xff\xfe\"}}"}};
  for (const auto& [what, text] : configs) {
    const TempFolder folder;
    folder.Put("c.json", text);
    const Ran ran = RunForked(folder, {"generate", "c.json", "--out", "set"});
    ExpectOneLine(ran, 2, {"c.json"});
    EXPECT_LT(ran.err.size(), 600u) << what;
    EXPECT_FALSE(fs::exists(folder / "set")) << what;
  }
}

}  // namespace
}  // namespace shimmer::app
