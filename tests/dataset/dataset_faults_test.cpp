// What a kill, a full disk and an unwritable folder leave: whole clips, or nothing.
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "tests/dataset/small_set.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kClips = 30;

void CommitTheRest(DatasetWriter& writer, const Layout& layout) {
  const std::set<int64_t> done = writer.done();
  for (int64_t clip = 0; clip < kClips; ++clip)
    if (!done.contains(clip)) CommitNow(writer, clip, SmallClip(layout, clip), {});
}

// Every file named in the manifest is there and right; no other clip's file is there.
void ExpectOnlyWholeClips(const fs::path& folder) {
  std::set<std::string> named = {"dataset.json", "manifest.jsonl"};
  auto tree = Tree(folder);
  const Manifest manifest(folder / "manifest.jsonl");
  for (const int64_t clip : manifest.done()) {
    const Json line = manifest.Line(clip);
    for (const Json& file : line["files"]) {
      const std::string path = file["path"];
      named.insert(path);
      EXPECT_EQ(Sha256Hex(AsBytes(tree[path])), file["sha256"]) << path;
    }
  }
  for (const auto& [path, bytes] : tree) EXPECT_TRUE(named.contains(path)) << path;
}

TEST(DatasetFaults, KilledAtAnyMomentItResumesToTheSameSet) {
  std::mt19937 generator(1);
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder whole, killed;
    {
      DatasetWriter writer(whole.path(), layout, Description());
      CommitTheRest(writer, layout);
    }
    for (int kill_number = 0; kill_number < 25; ++kill_number) {
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        try {
          DatasetWriter writer(killed.path(), layout, Description());
          CommitTheRest(writer, layout);
        } catch (...) {
          _exit(1);
        }
        _exit(0);
      }
      usleep(std::uniform_int_distribution<int>(0, 2500)(generator));
      kill(child, SIGKILL);
      int status = 0;
      waitpid(child, &status, 0);
      EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << "opening after a kill failed";
      DatasetWriter writer(killed.path(), layout, Description());  // which cleans up
      if (layout.kind == LayoutKind::kPairs) ExpectOnlyWholeClips(killed.path());
    }
    {
      DatasetWriter writer(killed.path(), layout, Description());
      CommitTheRest(writer, layout);
    }
    ExpectOnlyWholeClips(killed.path());
    EXPECT_EQ(Tree(killed.path()), Tree(whole.path()));
  }
}

TEST(DatasetFaults, AClipFolderWithoutAManifestLineIsReplaced) {
  const TempFolder folder;
  DatasetWriter writer(folder.path(), Sequence(), Description());
  folder.Put("clips/000000/turb/0000.png", "half of something");
  folder.Put("clips/000000/mask/0000.png", "of an older program");
  CommitNow(writer, 0, SmallClip(Sequence(), 0), {});
  ExpectOnlyWholeClips(folder.path());
}

TEST(DatasetFaults, FilesOfPairsWithoutAManifestLineAreRemovedOnOpening) {
  const TempFolder folder;
  const Layout layout = Pairs();
  {
    DatasetWriter writer(folder.path(), layout, Description());
    CommitNow(writer, 0, SmallClip(layout, 0), {});
  }
  // Clip 1 was killed between its renames; clip 0 just after its manifest line.
  folder.Put(layout.Path(FrameKind::kTurb, 1, 0), "renamed");
  folder.Put(".staging/1/" + layout.Path(FrameKind::kTurb, 1, 1), "not yet");
  folder.Put(".staging/0/x", "");
  DatasetWriter writer(folder.path(), layout, Description());
  ExpectOnlyWholeClips(folder.path());
  EXPECT_EQ(Tree(folder.path()).size(), SmallClip(layout, 0).size() + 2);
  EXPECT_FALSE(fs::exists(folder / ".staging"));
}

TEST(DatasetFaults, AFailedClipLeavesNoFiles) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder folder;
    DatasetWriter writer(folder.path(), layout, Description());
    folder.Put(layout.Path(FrameKind::kTurb, 0, 1), "left by a kill");
    FailNow(writer, 0, {{"error", "bad source"}});
    ExpectOnlyWholeClips(folder.path());
    EXPECT_EQ(Manifest(folder / "manifest.jsonl").Line(0)["error"], "bad source");
  }
}

TEST(DatasetFaults, UnwritableTarget) {
  const TempFolder folder;
  folder.Put("file", "x");
  for (const fs::path& target : {folder / "file/set", fs::path("/proc/set")}) {
    const std::string error =
        ErrorOf<std::runtime_error>([&] { DatasetWriter(target, Sequence(), Description()); });
    EXPECT_TRUE(Contains(error, target.parent_path().string())) << error;
  }
}

TEST(DatasetFaults, AClipThatCantBeWrittenIsNotThere) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder folder;
    DatasetWriter writer(folder.path(), layout, Description());
    CommitNow(writer, 0, SmallClip(layout, 0), {});
    // No file may pass 4000 bytes: the second of the clip's files fails as on a full disk.
    auto files = SmallClip(layout, 1);
    files[1].bytes.resize(8000);
    rlimit old_limit, limit;
    getrlimit(RLIMIT_FSIZE, &old_limit);
    limit = old_limit;
    limit.rlim_cur = 4000;
    const auto old_handler = signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = ErrorOf<std::runtime_error>([&] { CommitNow(writer, 1, files, {}); });
    setrlimit(RLIMIT_FSIZE, &old_limit);
    signal(SIGXFSZ, old_handler);
    EXPECT_TRUE(Contains(error, "File too large") && Contains(error, folder.path().string())) << error;
    ExpectOnlyWholeClips(folder.path());
    CommitNow(writer, 1, SmallClip(layout, 1), {});
    EXPECT_EQ(writer.done(), (std::set<int64_t>{0, 1}));
  }
}

TEST(DatasetFaults, AManifestLineThatCantBeWrittenTakesItsClipWithIt) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder folder;
    auto writer = std::make_unique<DatasetWriter>(folder.path(), layout, Description());
    CommitNow(*writer, 0, SmallClip(layout, 0), {});
    rlimit old_limit, limit;
    getrlimit(RLIMIT_FSIZE, &old_limit);
    limit = old_limit;
    limit.rlim_cur = fs::file_size(folder / "manifest.jsonl") + 10;  // torn after ten bytes
    const auto old_handler = signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error =
        ErrorOf<std::runtime_error>([&] { CommitNow(*writer, 1, SmallClip(layout, 1), {}); });
    setrlimit(RLIMIT_FSIZE, &old_limit);
    signal(SIGXFSZ, old_handler);
    EXPECT_TRUE(Contains(error, "manifest.jsonl")) << error;
    ExpectOnlyWholeClips(folder.path());
    // Nothing is taken any more until the folder is opened again.
    EXPECT_THROW(CommitNow(*writer, 2, SmallClip(layout, 2), {}), std::runtime_error);
    writer.reset();
    writer = std::make_unique<DatasetWriter>(folder.path(), layout, Description());
    CommitNow(*writer, 2, SmallClip(layout, 2), {});
    EXPECT_EQ(Manifest(folder / "manifest.jsonl").done(), (std::set<int64_t>{0, 2}));
  }
}

TEST(DatasetFaults, FullDisk) {
  const TempFolder folder;
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0)
    GTEST_SKIP() << "no permission to mount a small file system";
  std::string error;
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const fs::path set = disk / (layout.kind == LayoutKind::kPairs ? "pairs" : "sequence");
    try {
      DatasetWriter writer(set, layout, Description());
      for (int64_t clip = 0; clip < 1000; ++clip) CommitNow(writer, clip, SmallClip(layout, clip), {});
    } catch (const std::runtime_error& full) {
      error = full.what();
    }
    EXPECT_TRUE(Contains(error, "No space left on device") && Contains(error, set.string())) << error;
    ExpectOnlyWholeClips(set);
    const size_t done = Manifest(set / "manifest.jsonl").done().size();
    EXPECT_GT(done, 0u);
    // With more room it goes on from there.
    EXPECT_EQ(mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=4m"), 0);
    {
      DatasetWriter writer(set, layout, Description());
      EXPECT_EQ(writer.done().size(), done);
      CommitTheRest(writer, layout);
    }
    ExpectOnlyWholeClips(set);
    fs::remove_all(set);
    EXPECT_EQ(mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=256k"), 0);
  }
  umount(disk.c_str());
}

}  // namespace
}  // namespace shimmer::dataset
