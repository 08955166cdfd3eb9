// Fault 11: damaged pictures among the sources. None ends the run; their clips fail, and the rest is made.
#include <random>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

using Bytes = std::vector<uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr int kPicturesPerRun = 200;

struct Damage {
  std::string format, kind;
};

class DamagedSources : public testing::TestWithParam<Damage> {
 protected:
  // Whole pictures of this format, of several kinds of samples and ways of packing them.
  void SetUp() override {
    const std::string& format = GetParam().format;
    const OIIO::TypeDesc types[] = {OIIO::TypeUInt8, OIIO::TypeUInt16, OIIO::TypeHalf, OIIO::TypeFloat};
    for (const int channels : {1, 3})
      for (const size_t type : format == "jpg"   ? std::vector<size_t>{0}
                               : format == "png" ? std::vector<size_t>{0, 1}
                                                 : std::vector<size_t>{2, 3}) {
        cv::Mat picture = dataset::RandomImage({60, 45}, channels, static_cast<uint32_t>(type), 0, 0.2f);
        for (int y = 0; y < picture.rows; ++y) picture.row(y) += cv::Scalar::all(y / 64.);
        const std::string name = "whole" + std::to_string(channels) + std::to_string(type) + "." + format;
        PutWithOiio(folder_, name, picture, types[type]);
        whole_.push_back(dataset::ReadFile(folder_ / name));
      }
  }

  uint32_t Below(size_t end) { return static_cast<uint32_t>(random_() % end); }

  Bytes Damaged() {
    Bytes bytes = whole_[Below(whole_.size())];
    const size_t header = std::min<size_t>(bytes.size(), GetParam().format == "exr" ? 400 : 40);
    const std::string& kind = GetParam().kind;
    if (kind == "truncated") bytes.resize(1 + Below(bytes.size() - 1));
    for (uint32_t times = 1 + Below(8); kind == "flipped" && times > 0; --times)
      bytes[Below(bytes.size())] ^= static_cast<uint8_t>(1u << Below(8));
    for (uint32_t times = 1 + Below(4); kind == "header" && times > 0; --times)
      bytes[Below(header)] = static_cast<uint8_t>(Below(256));
    return bytes;
  }

  // By the reader itself, for the time that each takes.
  double LongestRead_s(const std::vector<fs::path>& files) {
    double longest = 0;
    for (const fs::path& file : files) {
      const auto start = Clock::now();
      try {
        dataset::ReadImage(file);
        ++read_;
      } catch (const std::runtime_error&) {
        ++refused_;
      }
      longest = std::max(longest, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return longest;
  }

  TempFolder folder_;
  std::vector<Bytes> whole_;
  std::mt19937 random_{11};
  int64_t read_ = 0, refused_ = 0;
};

std::vector<Damage> AllDamage() {
  std::vector<Damage> all;
  for (const char* format : {"png", "exr", "jpg"})
    for (const char* kind : {"truncated", "flipped", "header"}) all.push_back({format, kind});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Kinds, DamagedSources, testing::ValuesIn(AllDamage()),
                         [](const auto& info) { return info.param.format + "_" + info.param.kind; });

TEST_P(DamagedSources, FailAndTheRestIsMade) {
  const int pictures = Times(60, 2000);
  size_t seen = 0;
  double longest_s = 0;
  int64_t all_read = 0, all_refused = 0;
  for (int made = 0; made < pictures; made += kPicturesPerRun) {
    fs::remove_all(folder_ / "in");
    fs::remove_all(folder_ / "set");
    std::vector<fs::path> files;
    const int now = std::min(kPicturesPerRun, pictures - made);
    for (int i = 0; i < now; ++i)
      files.push_back(folder_.Put("in/" + std::to_string(i) + "." + GetParam().format, Damaged()));
    for (size_t i = 0; i < whole_.size(); ++i)
      folder_.Put("in/good" + std::to_string(i) + "." + GetParam().format, whole_[i]);
    // Of five draws each 99 % of the pictures are drawn.
    folder_.Put(
        "c.json",
        SmallConfig({{"clips", 5 * now}, {"frames", 1}, {"size", {8, 8}}, {"source", {{"images", "in"}}}}));
    const Ran ran = Shimmer(folder_, GenerateWords("c.json", "set"));
    EXPECT_LE(ran.exit_code, 1) << ran.err;
    const dataset::DatasetReader set(folder_ / "set");
    EXPECT_EQ(set.clips().size() + set.failed().size(), static_cast<size_t>(5 * now));
    EXPECT_EQ(ran.exit_code, set.failed().empty() ? 0 : 1);
    if (ran.exit_code == 1) ExpectOneLine(ran, 1, {"clips failed"});
    std::set<std::string> drawn;
    for (const Json& line : ManifestLines(folder_ / "set")) {
      const auto path = line.at("source").at("path").get<std::string>();
      drawn.insert(path);
      if (line.at("status") == "failed") {
        EXPECT_FALSE(path.starts_with("in/good")) << line.at("error");
        EXPECT_THAT(line.at("error").get<std::string>(), testing::StartsWith(path + ": "));
      }
    }
    seen += drawn.size() - std::min(drawn.size(), whole_.size());
    EXPECT_EQ(BrokenFiles(folder_ / "set"), Words());
    // In a process of its own, for what the reader may do to it.
    Running reader(folder_.path(), [&] {
      const double longest_read_s = LongestRead_s(files);
      std::printf("%f %lld %lld", longest_read_s, static_cast<long long>(read_),
                  static_cast<long long>(refused_));
      return 0;
    });
    const Ran read = reader.Wait();
    EXPECT_EQ(read.exit_code, 0) << read.err;
    double seconds = 0;
    long long whole = 0, refused = 0;
    EXPECT_EQ(std::sscanf(read.out.c_str(), "%lf %lld %lld", &seconds, &whole, &refused), 3);
    longest_s = std::max(longest_s, seconds);
    all_read += whole;
    all_refused += refused;
  }
  if (InSoak()) {
    EXPECT_LT(longest_s, 5);
  }
  if (GetParam().kind == "truncated") {
    EXPECT_EQ(all_read, 0);
  }
  Tell("11 damaged, " + GetParam().format + " " + GetParam().kind + ": " + std::to_string(pictures) +
       " pictures, " + std::to_string(all_refused) + " refused, " + std::to_string(all_read) +
       " read, 0 crashes; " + std::to_string(seen) + " as sources; longest read " +
       std::to_string(longest_s) + " s");
}

// What others have collected: ../shared/data/formats, where it is there.
TEST(DamagedSourcesOfOthers, FailAndTheRestIsMade) {
  const fs::path formats = fs::path(SHIMMER_SHARED_DIR) / "data/formats";
  if (!fs::exists(formats)) GTEST_SKIP() << "no such test data: " << formats;
  const TempFolder folder;
  int count = 0;
  const auto take = [&](const fs::path& from, const std::string& extension) {
    for (const auto& entry : fs::directory_iterator(from))
      if (entry.is_regular_file() && (extension == ".exr" || entry.path().extension() == extension)) {
        fs::create_directories(folder / "in");
        fs::copy_file(entry.path(), folder / ("in/" + std::to_string(count++) + extension));
      }
  };
  take(formats / "exr_damaged", ".exr");
  take(formats / "D04_png/libpng_testpngs/crashers", ".png");
  take(formats / "D04_png/pngsuite", ".png");
  WritePng(folder, "in/good.png", dataset::RandomImage({40, 30}, 3, 1));
  folder.Put(
      "c.json",
      SmallConfig({{"clips", 5 * count}, {"frames", 1}, {"size", {8, 8}}, {"source", {{"images", "in"}}}}));
  const Ran ran = Shimmer(folder, GenerateWords("c.json", "set"));
  ExpectOneLine(ran, 1, {"clips failed"});
  const dataset::DatasetReader set(folder / "set");
  EXPECT_EQ(set.clips().size() + set.failed().size(), static_cast<size_t>(5 * count));
  Tell("11 damaged, of others: " + std::to_string(count) + " files, " + std::to_string(set.failed().size()) +
       " of " + std::to_string(5 * count) + " clips failed, 0 crashes");
}

}  // namespace
}  // namespace shimmer::app
