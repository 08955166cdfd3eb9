#include "sim/dataset/manifest.h"

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

const std::string kDone0 = R"({"clip":0,"status":"done","x":1})"
                           "\n";
const std::string kFailed1 = R"({"clip":1,"error":"why","status":"failed"})"
                             "\n";
const std::string kDone1 = R"({"clip":1,"status":"done"})"
                           "\n";

TEST(Manifest, AbsentAndEmptyAreEmpty) {
  const TempFolder folder;
  EXPECT_TRUE(Manifest(folder / "no").done().empty());
  EXPECT_TRUE(Manifest(folder.Put("m", "")).done().empty());
}

TEST(Manifest, TheLastLineOfAClipCounts) {
  const TempFolder folder;
  const Manifest failed(folder.Put("a", kDone0 + kFailed1));
  EXPECT_EQ(failed.done(), std::set<int64_t>{0});
  EXPECT_EQ(failed.failed(), std::set<int64_t>{1});
  EXPECT_EQ(failed.Line(1)["error"], "why");
  const Manifest done(folder.Put("b", kDone0 + kFailed1 + kDone1));
  EXPECT_EQ(done.done(), (std::set<int64_t>{0, 1}));
  EXPECT_TRUE(done.failed().empty());
  EXPECT_FALSE(done.Line(1).contains("error"));
  EXPECT_EQ(done.Line(0)["x"], 1);
  EXPECT_THROW(done.Line(2), std::runtime_error);
}

TEST(Manifest, EveryLineThatCountsOnceInTheOrderOfItsClip) {
  const TempFolder folder;
  const auto lines = [](const Manifest& manifest) {
    std::vector<std::string> lines;
    manifest.ForEachLine([&](int64_t, const Json& line) { lines.push_back(line.dump() + "\n"); });
    return lines;
  };
  const auto path = folder.Put("m", kFailed1 + kDone0 + kDone1 + "{\"clip\":2,\"sta");
  EXPECT_EQ(lines(Manifest(path)), (std::vector<std::string>{kDone0, kDone1}));
  EXPECT_TRUE(lines(Manifest(folder / "no")).empty());
  const Manifest manifest(path);
  folder.Put("m", kDone1 + kDone0);
  EXPECT_THROW(lines(manifest), std::runtime_error);  // has changed meanwhile
}

// More than are kept open, and clips that lie in one after the other.
TEST(Manifest, OfAHundredShards) {
  const TempFolder folder;
  constexpr int kShards = 100, kClips = 250;
  std::vector<std::filesystem::path> paths;
  for (int shard = 0; shard < kShards; ++shard) {
    std::string lines;
    for (int clip = shard; clip < kClips; clip += kShards)
      lines += R"({"clip":)" + std::to_string(clip) + R"(,"status":"done"})" + "\n";
    paths.push_back(folder.Put(std::to_string(shard), lines));
  }
  int64_t next = 0;
  Manifest(paths).ForEachLine([&](int64_t clip, const Json& line) {
    EXPECT_EQ(clip, next++);
    EXPECT_EQ(line.at("clip"), clip);
  });
  EXPECT_EQ(next, kClips);
}

// A line that can't be read is not a line that is not there: what follows it would be cut off.
TEST(Manifest, ThatCannotBeReadIsAnError) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "m");
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { Manifest manifest(folder / "m"); }), "can't be read"));
}

TEST(Manifest, ATornLastLineIsNotThere) {
  const TempFolder folder;
  for (size_t cut = 0; cut < kDone1.size(); ++cut) {  // the newline alone may be missing
    const auto path = folder.Put("m", kDone0 + kDone1.substr(0, cut));
    const Manifest manifest(path);
    EXPECT_EQ(manifest.done(), std::set<int64_t>{0}) << cut;
    EXPECT_EQ(manifest.whole_bytes(path), kDone0.size());
    const std::vector<Json> lines = {Json::parse(kFailed1)};
    ManifestWriter(path, manifest.whole_bytes(path)).Append(lines);
    const std::vector<uint8_t> bytes = ReadFile(path);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), kDone0 + kFailed1) << cut;
  }
  // After a power cut a line may be zeros, or end in a newline all the same.
  for (const std::string& torn : {std::string(100, '\0'), std::string("{\"clip\":1,\"sta\n")}) {
    const auto path = folder.Put("m", kDone0 + torn);
    EXPECT_EQ(Manifest(path).whole_bytes(path), kDone0.size());
  }
}

TEST(Manifest, ADamagedLineElsewhereIsAnErrorWithItsNumber) {
  const TempFolder folder;
  for (const std::string line :
       {"{\"clip\":1,\"sta\n", "\n", "{}\n", "[]\n", "7\n", "{\"clip\":-1,\"status\":\"done\"}\n",
        "{\"clip\":1.5,\"status\":\"done\"}\n", "{\"clip\":1,\"status\":\"maybe\"}\n",
        "{\"clip\":1,\"status\":7}\n"}) {
    const auto path = folder.Put("m", kDone0 + line + kDone1);
    const std::string error = ErrorOf<std::runtime_error>([&] { Manifest manifest(path); });
    EXPECT_TRUE(Contains(error, path.string() + ":2: damaged line")) << line << error;
  }
  // Valid JSON was never torn: not at the end either.
  EXPECT_THROW(Manifest(folder.Put("m", kDone0 + "{\"clip\":1}\n")), std::runtime_error);
}

TEST(Manifest, LinesAreWhole) {
  const TempFolder folder;
  {
    ManifestWriter writer(folder / "m", 0);
    const std::vector<Json> lines = {
        {{"clip", 0}, {"status", "done"}, {"text", "two\nlines and \xff\xfe no UTF-8"}},
        {{"clip", 1}, {"status", "failed"}}};
    writer.Append(lines);
  }
  const Manifest manifest(folder / "m");
  EXPECT_EQ(manifest.done(), std::set<int64_t>{0});
  EXPECT_EQ(manifest.failed(), std::set<int64_t>{1});
  EXPECT_TRUE(Contains(manifest.Line(0)["text"], "two\nlines"));
}

TEST(Manifest, ALineThatChangedUnderneath) {
  const TempFolder folder;
  const auto path = folder.Put("m", kDone0 + kDone1);
  const Manifest manifest(path);
  folder.Put("m", "short\n");
  EXPECT_THROW(manifest.Line(1), std::runtime_error);
}

}  // namespace
}  // namespace shimmer::dataset
