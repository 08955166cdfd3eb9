// configs/photos_train.txt and configs/photos_eval.txt: no photograph that a method is judged by is one that
// it was trained with.
#include "sim/app/config/config.h"
#include "sim/dataset/pattern_list.h"
#include "sim/dataset/sources.h"
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

const fs::path kConfigs = fs::path(SHIMMER_SOURCE_DIR) / "configs";

// What a file shows, whatever its size: wallpapers lie in a folder for each, with links among their sizes.
std::string MotifOf(const fs::path& photograph) {
  const std::string place = fs::weakly_canonical(photograph).string(), all = "/usr/share/wallpapers/";
  return place.starts_with(all) ? place.substr(0, place.find('/', all.size())) : place;
}

std::set<std::string> MotifsOf(const Words& patterns) {
  const fs::path bases[] = {kConfigs, ""};
  std::set<std::string> motifs;
  for (const fs::path& file : dataset::FindFiles(patterns, bases, dataset::FileKind::kPicture))
    motifs.insert(MotifOf(file));
  return motifs;
}

Words LinesOf(const char* list) {
  Words lines;
  for (const dataset::ListedPattern& listed : dataset::ReadPatternList(kConfigs / list))
    lines.push_back(listed.pattern);
  return lines;
}

// One of each package's photographs stands for all of them.
bool PhotographsAreInstalled() {
  return std::ranges::all_of(
      Words{"/usr/share/backgrounds/Wine_by_Jakkub_Mede.jpg",
            "/usr/share/backgrounds/Kleiber_by_Lukas_Baubkus.jpg",
            "/usr/share/backgrounds/mate/nature/Wood.jpg", "/usr/share/wallpapers/Path"},
      [](const std::string& path) { return fs::exists(path); });
}

constexpr const char* kNotInstalled = "the photographs of scripts/setup.sh --photos are not on this machine";

TEST(PhotoLists, NameEachPhotographOnce) {
  std::set<std::string> motifs;
  for (const auto& [list, count] : {std::pair("photos_train.txt", 28u), std::pair("photos_eval.txt", 8u)}) {
    const Words lines = LinesOf(list);
    EXPECT_EQ(lines.size(), count) << list;
    for (const std::string& line : lines) EXPECT_TRUE(motifs.insert(MotifOf(line)).second) << line;
  }
}

TEST(PhotoLists, FindWhatTheyName) {
  if (!PhotographsAreInstalled()) GTEST_SKIP() << kNotInstalled;
  EXPECT_EQ(MotifsOf({"photos_train.txt"}).size(), 28u);
  EXPECT_EQ(MotifsOf({"photos_eval.txt"}).size(), 8u);
}

// A crop of full HD fits into each, with 64 px of shake around it.
TEST(PhotoLists, PhotographsToJudgeByAreLarge) {
  if (!PhotographsAreInstalled()) GTEST_SKIP() << kNotInstalled;
  for (const std::string& path : LinesOf("photos_eval.txt")) {
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_TRUE(input) << path;
    EXPECT_GE(input->spec().width, 2100) << path;
    EXPECT_GE(input->spec().height, 1240) << path;
    EXPECT_EQ(input->spec().nchannels, 3) << path;
  }
}

TEST(PhotoLists, NoTrainingConfigFindsAPhotographToJudgeBy) {
  if (!PhotographsAreInstalled()) GTEST_SKIP() << kNotInstalled;
  const std::set<std::string> judged = MotifsOf({"photos_eval.txt"});
  int configs = 0;
  for (const auto& entry : fs::directory_iterator(kConfigs)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" ||
        !(name.starts_with("train") || name == "exr_linear.json" || name == "demo_photos.json"))
      continue;
    const Words images = ConfigFile::Parse(ReadText(entry.path())).fixed().source.images;
    if (images.empty()) continue;
    ++configs;
    for (const std::string& motif : MotifsOf(images))
      EXPECT_FALSE(judged.contains(motif)) << name << " " << motif;
  }
  EXPECT_GE(configs, 3);
}

}  // namespace
}  // namespace shimmer::app
