// Every config that ships runs, and its data set reads back as the config says.
#include "sim/app/config/config.h"
#include "sim/dataset/pixel_hash.h"
#include "sim/dataset/sha256.h"
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

// Bits of a sample, as the file has them.
int BitsIn(const fs::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  return input ? static_cast<int>(8 * input->spec().format.size()) : 0;
}

std::vector<std::string> ConfigNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(SHIMMER_SOURCE_DIR) / "configs"))
    if (entry.path().extension() == ".json" && entry.path().stem() != "schema")
      names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

// Each file that a manifest line names is there, with the hash that the line gives, and no other is.
void ExpectFilesOfManifest(const fs::path& data_set) {
  std::set<std::string> named, there;
  for (const Json& line : ManifestLines(data_set))
    for (const Json& file : line.at("files")) {
      const auto path = file.at("path").get<std::string>();
      named.insert(path);
      EXPECT_EQ(dataset::Sha256HexOfFile(data_set / path), file.at("sha256")) << path;
    }
  for (const auto& [path, content] : Tree(data_set)) there.insert(path);
  named.insert({"dataset.json", "manifest.jsonl", "report.html"});
  EXPECT_EQ(there, named);
}

void ExpectFramesAsConfig(const dataset::DatasetReader& reader, const fs::path& data_set,
                          const ConfigFile& file) {
  for (const int64_t clip : reader.clips()) {
    const Config config = file.Draw(static_cast<uint64_t>(clip), nullptr);
    const bool pairs = config.output.layout == LayoutKind::kPairs;
    ASSERT_EQ(reader.FrameCount(clip), pairs ? config.output.frames_per_clip : config.frames);
    for (int64_t frame = 0; frame < reader.FrameCount(clip); ++frame) {
      const auto turb = reader.Turb(clip, frame), clean = reader.Clean(clip, frame);
      EXPECT_EQ(turb.pixels.size(), config.size);
      EXPECT_EQ(clean.pixels.size(), config.size);
      EXPECT_EQ(turb.pixels.type(), clean.pixels.type());
      const auto has = [&](const char* kind) { return std::ranges::count(config.output.truth, kind) > 0; };
      EXPECT_EQ(reader.TruthTilt(clip, frame).has_value(), has("tilt"));
      EXPECT_EQ(reader.TruthMask(clip, frame).has_value(), has("mask"));
      EXPECT_EQ(reader.TruthFlow(clip, frame).has_value(), has("flow") && frame + 1 < config.frames);
      EXPECT_EQ(reader.TruthShake(clip).has_value(), has("shake"));
      if (const auto sigma = reader.TruthSigma(clip, frame)) {
        EXPECT_EQ(sigma->size(), config.size);
      }
    }
    const dataset::ClipFiles files = reader.Files(clip);
    for (const auto& file : {files.turb.front(), files.clean.back()})
      EXPECT_EQ(BitsIn(data_set / file.path), config.output.bits) << file.path;
  }
}

class Configs : public testing::TestWithParam<std::string> {};

TEST_P(Configs, RunAndReadBack) {
  const TempFolder folder;
  const fs::path config = fs::path(SHIMMER_SOURCE_DIR) / "configs" / (GetParam() + ".json");
  const Json given = Json::parse(ReadText(config));
  const int kept = given.value("/output/frames_per_clip"_json_pointer, 1);
  const Ran ran = Generate(
      folder, config.string(), "set",
      {"--set", "clips=2", "--set", "frames=" + std::to_string(std::max(2, kept)), "--set", "size=[96,64]"});
  if (ran.exit_code == 2 && dataset::Contains(ran.err, "nothing found"))
    GTEST_SKIP() << "its sources are not on this machine: " << ran.err;
  ExpectDone(ran);
  const dataset::DatasetReader reader(folder / "set");
  EXPECT_EQ(reader.clips(), (std::set<int64_t>{0, 1}));
  const Json resolved = reader.description().at("config");
  ExpectFramesAsConfig(reader, folder / "set", ConfigFile::Parse(resolved.dump()));
  ExpectFilesOfManifest(folder / "set");
}

INSTANTIATE_TEST_SUITE_P(Program, Configs, testing::ValuesIn(ConfigNames()),
                         [](const auto& info) { return info.param; });

// A config with every key of the design, on photographs.
constexpr const char* kDesignConfig = R"({
  "seed": 7, "clips": 2, "frames": 16, "size": [256, 256], "first_frame": 0,
  "source": {"images": "PHOTOS/**/*.png", "scale": {"uniform": [0.5, 1]}, "crop": "random", "flip": true},
  "tilt": {"strength_px": {"uniform": [1, 10]}, "base_frequency": {"uniform": [0.015, 0.06]}, "octaves": 8,
           "lacunarity": 2, "persistence": 0.5, "temporal_scale": {"uniform": [0.5, 4]}, "lattice": "seeded",
           "kernel": 0.6, "interpolation": "bicubic"},
  "blur": {"min_sigma_px": 0, "max_sigma_px": {"uniform": [0.5, 6]}, "base_frequency": 0.015, "octaves": 11,
           "tilt_weight": 0.5, "temporal_scale": 2, "method": "auto"},
  "camera": {}, "objects": [], "sensor": {},
  "colour": "stored",
  "accuracy": {"max_error_px": 0.05, "max_error_levels": 0.1},
  "output": {"format": "png", "bits": 8, "layout": "sequence", "truth": ["tilt", "sigma"], "name": "shimmer",
             "test_fraction": 0.02, "frames_per_clip": 1}
})";

TEST(Program, RunsTheConfigOfTheDesignOnPhotographs) {
  const fs::path photos = fs::path(SHIMMER_SHARED_DIR) / "data/photos/kodak8";
  if (!fs::exists(photos)) GTEST_SKIP() << photos << " is not on this machine";
  const TempFolder folder;
  std::string config = kDesignConfig;
  config.replace(config.find("PHOTOS"), 6, photos.string());
  folder.Put("design.json", config);
  ExpectDone(Generate(folder, "design.json", "set"));
  const dataset::DatasetReader reader(folder / "set");
  EXPECT_EQ(reader.clips(), (std::set<int64_t>{0, 1}));
  ExpectFramesAsConfig(reader, folder / "set", ConfigFile::Parse(config));
  ExpectFilesOfManifest(folder / "set");
  for (const Json& line : ManifestLines(folder / "set")) {
    EXPECT_EQ(line.at("files").size(), 16u + 1u + 16u);  // one clean file: a photograph doesn't move
    EXPECT_EQ(line.at("tilt.origin_x").size(), 8u);      // seeded: one for each octave
    EXPECT_EQ(line.at("source").at("sha256"),
              dataset::Sha256HexOfFile(line.at("source").at("path").get<std::string>()));
    const double strength_px = line.at("drawn").at("tilt.strength_px");
    EXPECT_NEAR(line.at("tilt_rms_px").get<double>(), 0.247 * strength_px, 0.05 * strength_px);
  }
}

// The manifest's hash of pixels is that of the picture that a reader decodes, whatever the compressor did.
TEST(Program, NamesTheHashOfDecodedPixels) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 1}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const Json files = ManifestLines(folder / "set").at(0).at("files");
  for (const Json& file : files) {
    const auto picture = dataset::ReadImage(folder / ("set/" + file.at("path").get<std::string>()));
    EXPECT_EQ(file.at("pixels"), dataset::PixelHash(picture.pixels, {dataset::FileFormat::kPng, 8}));
  }
}

// output.png_writer changes the files and no pixel of them.
TEST(Program, WritesPngEitherWay) {
  for (const int bits : {8, 16}) {
    const TempFolder folder;
    folder.Put("c.json", SmallConfig({{"clips", 1}, {"output", {{"bits", bits}}}}));
    ExpectDone(Generate(folder, "c.json", "usual"));
    ExpectDone(Generate(folder, "c.json", "isal", {"--set", "output.png_writer=isal"}));
    ExpectDone(Generate(folder, "c.json", "openimageio", {"--set", "output.png_writer=openimageio"}));
    EXPECT_EQ(Tree(folder / "usual"), Tree(folder / "isal"));
    const Json ours = ManifestLines(folder / "isal").at(0).at("files");
    const Json theirs = ManifestLines(folder / "openimageio").at(0).at("files");
    ASSERT_EQ(ours.size(), 3u);
    ASSERT_EQ(theirs.size(), ours.size());
    for (size_t i = 0; i < ours.size(); ++i) {
      EXPECT_EQ(ours[i].at("pixels"), theirs[i].at("pixels"));
      EXPECT_NE(ours[i].at("sha256"), theirs[i].at("sha256"));
    }
  }
}

}  // namespace
}  // namespace shimmer::app
