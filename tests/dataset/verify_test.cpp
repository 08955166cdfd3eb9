#include "sim/dataset/verify.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/dataset/picture_set.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Lines = std::vector<std::string>;

constexpr Encoding kPng8{FileFormat::kPng, 8}, kPng16{FileFormat::kPng, 16}, kHalf{FileFormat::kExr, 16},
    kFloat{FileFormat::kExr, 32};
constexpr LayoutKind kAllLayouts[] = {LayoutKind::kSequence, LayoutKind::kPairs, LayoutKind::kRestormer,
                                      LayoutKind::kBasicsr, LayoutKind::kWebdataset};
constexpr LayoutKind kFileLayouts[] = {LayoutKind::kSequence, LayoutKind::kPairs, LayoutKind::kRestormer,
                                       LayoutKind::kBasicsr};
constexpr const char* kOtherBytes = ": damaged: its SHA-256 is not that of the manifest";

TEST(Verify, AWholeSetHasNoProblem) {
  for (const LayoutKind kind : kAllLayouts)
    for (const Encoding encoding : {kPng8, kPng16, kHalf, kFloat})
      for (const bool with_failed : {false, true}) {
        const PictureSet set(kind, encoding, with_failed);
        EXPECT_THAT(set.Problems(), IsEmpty()) << static_cast<int>(kind) << " " << encoding.bits;
      }
}

TEST(Verify, FindsABitFlippedInAnyFile) {
  for (const LayoutKind kind : kFileLayouts)
    for (const Encoding encoding : {kPng8, kHalf}) {
      const PictureSet set(kind, encoding);
      uint32_t random = 1;
      for (const StoredFile& file : set.Files()) {
        random = random * 1664525 + 1013904223;
        const size_t byte = random % static_cast<size_t>(file.bytes);
        FlipBit(set / file.path, byte, static_cast<int>(random >> 29));
        EXPECT_THAT(set.Problems(), ElementsAre(file.path + kOtherBytes));
        FlipBit(set / file.path, byte, static_cast<int>(random >> 29));
      }
      EXPECT_THAT(set.Problems(), IsEmpty());
    }
}

// In members, in headers, in what fills up the blocks, and at the end: one problem each.
TEST(Verify, FindsABitFlippedAnywhereInATar) {
  const PictureSet set(LayoutKind::kWebdataset, kPng8);
  const fs::path tar = set / "shards/000001.tar";
  const std::vector<StoredFile> files = set.Files();
  int in_members = 0, between = 0;
  for (size_t byte = 0; byte < fs::file_size(tar); byte += 83) {
    FlipBit(tar, byte, static_cast<int>(byte % 8));
    const auto hit = std::ranges::find_if(files, [&](const StoredFile& file) {
      const auto place = static_cast<int64_t>(byte);
      return file.path == "shards/000001.tar" && place >= file.offset && place < file.offset + file.bytes;
    });
    const Lines problems = set.Problems();
    ASSERT_EQ(problems.size(), 1u) << byte;
    if (hit != files.end()) {
      ++in_members;
      EXPECT_EQ(problems[0], hit->name() + kOtherBytes);
    } else {
      ++between;
      EXPECT_EQ(problems[0], "shards/000001.tar: damaged: byte " + std::to_string(byte) +
                                 ", in a header or between members, is not what it was");
    }
    FlipBit(tar, byte, static_cast<int>(byte % 8));
  }
  EXPECT_GT(in_members, 20);
  EXPECT_GT(between, 20);
  EXPECT_THAT(set.Problems(), IsEmpty());
}

TEST(Verify, FindsWhatIsMissingTruncatedOrLonger) {
  for (const LayoutKind kind : kAllLayouts) {
    const PictureSet set(kind, kPng8);
    const std::string path = set.Files()[2].path;
    const std::vector<uint8_t> bytes = ReadFile(set / path);
    const std::string right = std::to_string(bytes.size());
    fs::remove(set / path);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": missing"));
    for (const size_t left : {size_t{0}, size_t{1}, bytes.size() / 2, bytes.size() - 1}) {
      WriteFile(set / path, std::span(bytes).first(left));
      EXPECT_THAT(set.Problems(),
                  ElementsAre(path + ": truncated: is " + std::to_string(left) + " bytes, must be " + right));
    }
    std::vector<uint8_t> longer = bytes;
    longer.push_back(0);
    WriteFile(set / path, longer);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": longer than it was: is " +
                                            std::to_string(longer.size()) + " bytes, must be " + right));
  }
}

// Files of other lengths too: what they hold says more than how long they are.
TEST(Verify, NamesWhatWasSwapped) {
  for (const LayoutKind kind : kFileLayouts) {
    const PictureSet set(kind, kPng8);
    const auto files = set.Files();
    const std::string a = files[0].path, b = files.back().path;  // a PNG and an EXR
    Swap(set / a, set / b);
    EXPECT_THAT(set.Problems(), UnorderedElementsAre(a + ": swapped: holds what belongs to " + b,
                                                     b + ": swapped: holds what belongs to " + a));
    Swap(set / a, set / b);
    fs::copy_file(set / a, set / b, fs::copy_options::overwrite_existing);
    EXPECT_THAT(set.Problems(), ElementsAre(b + ": swapped: holds what belongs to " + a));
  }
  const PictureSet tars(LayoutKind::kWebdataset, kPng8);
  const std::string a = "shards/000000.tar", b = "shards/000002.tar";  // of two clips and of one
  Swap(tars / a, tars / b);
  EXPECT_THAT(tars.Problems(), ElementsAre(a + ": swapped: holds what belongs to " + b,
                                           b + ": swapped: holds what belongs to " + a));
}

TEST(Verify, ALinkOrFolderIsNoFile) {
  for (const LayoutKind kind : kAllLayouts) {
    const PictureSet set(kind, kPng8);
    const std::string path = set.Files()[0].path;
    const TempFolder elsewhere;
    fs::rename(set / path, elsewhere / "same");
    fs::create_symlink(elsewhere / "same", set / path);  // leads to the right bytes, and out of the set
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": a link, must be a file"));
    fs::remove(set / path);
    fs::create_directory(set / path);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": a folder, must be a file"));
    fs::remove(set / path);
    ASSERT_EQ(mkfifo((set / path).c_str(), 0666), 0);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": a device or pipe, must be a file"));
  }
}

TEST(Verify, LinksToFoldersAreNotFollowed) {
  const PictureSet set(LayoutKind::kSequence, kPng8);
  const TempFolder elsewhere;
  fs::rename(set / "clips/000002/turb", elsewhere / "turb");
  fs::create_symlink(elsewhere / "turb", set / "clips/000002/turb");
  const std::string why = ": missing: clips/000002/turb is a link, must be a folder";
  EXPECT_THAT(set.Problems(),
              ElementsAre("clips/000002/turb/0000.png" + why, "clips/000002/turb/0001.png" + why,
                          "clips/000002/turb: surplus: a link"));
}

TEST(Verify, FindsWhatIsTooMuch) {
  for (const LayoutKind kind : kAllLayouts) {
    const PictureSet set(kind, kPng8);
    const fs::path folder = fs::path(set.Files()[0].path).parent_path();
    const std::string twin = (folder / "copy.png").string(), hidden = (folder / ".hidden").string();
    for (const std::string& name : {std::string("notes.txt"), std::string(".bashrc"), twin, hidden})
      WriteFile(set / name, AsBytes(name));
    fs::create_directories(set / "empty/inside");
    fs::create_directories(set / "more/empty");
    WriteFile(set / "more/file", AsBytes(std::string("x")));
    fs::create_symlink("/", set / "root");
    fs::create_symlink("nowhere", set / (folder / "dangling").string());
    // What we put there ourselves is known.
    for (const char* name : {".lock", ".lock.000-of-002", ".sources", ".origin.json", "report.html"})
      WriteFile(set / name, AsBytes(std::string("x")));
    fs::create_directories(set / ".surplus/empty");
    fs::create_directories(set / ".staging/3");
    EXPECT_THAT(
        set.Problems(),
        UnorderedElementsAre("notes.txt: surplus: no file of the set", ".bashrc: surplus: no file of the set",
                             twin + ": surplus: no file of the set", hidden + ": surplus: no file of the set",
                             "empty: surplus: an empty folder", "more/empty: surplus: an empty folder",
                             "more/file: surplus: no file of the set", "root: surplus: a link",
                             (folder / "dangling").string() + ": surplus: a link",
                             ".staging: surplus: what a run that was killed has left"));
  }
}

// Names that a clip might have, and this one has not.
TEST(Verify, FilesOfNoFrameAreTooMuch) {
  const PictureSet set(LayoutKind::kSequence, kPng8, /*with_failed=*/true);
  const Lines names = {"clips/000000/turb/0002.png", "clips/000000/clean/0001.png",  // one clean file
                       "clips/000003/turb/0000.png",                                 // failed
                       "clips/000005/turb/0000.png",                                 // not of the config
                       "clips/000000/turb/0000.exr", "clips.001/000000/turb/0000.png"};
  std::vector<std::string> expected;
  for (const std::string& name : names) {
    fs::create_directories((set / name).parent_path());
    WriteFile(set / name, AsBytes(name));
    expected.push_back(name + ": surplus: no file of the set");
  }
  std::ranges::sort(expected);
  EXPECT_EQ(set.Problems(), expected);
}

TEST(Verify, FoldersThatLackTheirFilesAreNotTooMuch) {
  const PictureSet set(LayoutKind::kSequence, kPng8);
  for (const char* name : {"0000.png", "0001.png"}) fs::remove(set / "clips/000001/turb" / name);
  EXPECT_THAT(set.Problems(),
              ElementsAre("clips/000001/turb/0000.png: missing", "clips/000001/turb/0001.png: missing"));
}

TEST(Verify, MissingClipsAreNamedAndWhatTheyLeftIsNotTooMuch) {
  for (const LayoutKind kind : kAllLayouts) {
    const PictureSet set(kind, kPng8, /*with_failed=*/true);
    set.ChangeLines([](Json& line) {
      if (line["clip"] == 1 || line["clip"] == 2) line = nullptr;
    });
    EXPECT_THAT(set.Problems(), ElementsAre("clips 1 to 2: missing: neither done nor failed"));
    const auto found = set.Found();
    ASSERT_TRUE(found[0].clips);
    EXPECT_EQ(found[0].clips->first, 1);
    EXPECT_EQ(found[0].clips->last, 2);
    fs::remove(set / "manifest.jsonl");
    EXPECT_THAT(set.Problems(), ElementsAre("clips 0 to 4: missing: neither done nor failed"));
  }
}

TEST(Verify, FindsDamagedLines) {
  const PictureSet set(LayoutKind::kPairs, kPng8);
  std::vector<uint8_t> bytes = ReadFile(set / "manifest.jsonl");
  const std::vector<uint8_t> whole = bytes;
  bytes[0] = '[';
  WriteFile(set / "manifest.jsonl", bytes);
  const Lines problems = set.Problems();
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0], "clip 0: missing: neither done nor failed");
  EXPECT_TRUE(Contains(problems[1], "manifest.jsonl:1: damaged line")) << problems[1];
  WriteFile(set / "manifest.jsonl", std::span(whole).first(whole.size() - 1));
  EXPECT_THAT(set.Problems(), ElementsAre("clip 4: missing: neither done nor failed",
                                          "manifest.jsonl: its last line is torn"));
}

TEST(Verify, FindsLinesThatSaySomethingElse) {
  for (const LayoutKind kind : kAllLayouts) {
    const auto problems_with = [&](const std::function<void(Json & line)>& change) {
      const PictureSet set(kind, kPng8);
      set.ChangeLines([&](Json& line) {
        if (line["clip"] == 1) change(line);
      });
      const auto found = set.Found();
      for (const Problem& problem : found) {
        EXPECT_TRUE(problem.clips && problem.clips->first <= 1 && problem.clips->last >= 1);
      }
      return found.size() == 1 ? found[0].name + ": " + found[0].text : std::to_string(found.size());
    };
    const std::string line = "clip 1: its line of the manifest ";
    EXPECT_EQ(problems_with([](Json& line) { line["frames"] = 3; }), line + "says 3 frames, must be 2");
    EXPECT_EQ(problems_with([](Json& line) { line["files"].erase(0); }),
              line + "names 1 turbulent files, must be 2");
    EXPECT_THAT(problems_with([](Json& line) { line["files"][1] = line["files"][0]; }),
                testing::AllOf(testing::StartsWith(line + "names "), testing::EndsWith(" twice")));
    EXPECT_THAT(problems_with([](Json& line) {
                  line["files"][0][line["files"][0].contains("member") ? "member" : "path"] = "../../passwd";
                }),
                testing::EndsWith("which is no file of this clip"));
    EXPECT_THAT(problems_with([](Json& line) { line["files"][0].erase("path"); }),
                testing::HasSubstr("must have a path"));
    EXPECT_THAT(problems_with([](Json& line) { line["files"][0]["pixels"] = "00"; }),
                testing::EndsWith(": damaged: its pixels are not those of the manifest"));
    EXPECT_THAT(problems_with([](Json& line) { line["files"][0]["sha256"] = "00"; }),
                testing::EndsWith(kOtherBytes));
    EXPECT_THAT(problems_with([](Json& line) { line["size"] = "7x5"; }),
                testing::EndsWith("must have size, channels and frames"));
  }
}

TEST(Verify, HoldsTheShapeOfAFrameAgainstItsLine) {
  const PictureSet set(LayoutKind::kSequence, kPng8);
  set.ChangeLines([](Json& line) {
    if (line["clip"] == 1) line["channels"] = 3;  // is grey
  });
  const std::string what = ": its size or channels are not those of its clip's line";
  EXPECT_THAT(set.Problems(),
              ElementsAre("clips/000001/clean/0000.png" + what, "clips/000001/clean/0001.png" + what,
                          "clips/000001/turb/0000.png" + what, "clips/000001/turb/0001.png" + what));
}

TEST(Verify, FindsAWrongOffsetInATar) {
  const PictureSet set(LayoutKind::kWebdataset, kPng8);
  set.ChangeLines([](Json& line) {
    if (line["clip"] == 0) line["files"][0]["offset"] = 513;
  });
  EXPECT_THAT(set.Problems(),
              ElementsAre("shards/000000.tar/000000.turb.0000.png: its offset in the manifest is "
                          "513, must be 512"));
}

TEST(Verify, DerivedFilesMustSayWhatTheManifestSays) {
  for (const auto& [kind, path] :
       std::vector<std::pair<LayoutKind, std::string>>{{LayoutKind::kRestormer, "set/train/meta_info.txt"},
                                                       {LayoutKind::kRestormer, "set/restormer.yml"},
                                                       {LayoutKind::kBasicsr, "meta_info.txt"},
                                                       {LayoutKind::kWebdataset, "shards/index.json"}}) {
    const PictureSet set(kind, kPng8);
    const std::vector<uint8_t> whole = ReadFile(set / path);
    FlipBit(set / path, 3, 0);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": damaged: says something else than the manifest"));
    fs::remove(set / path);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": missing"));
    const TempFolder elsewhere;
    fs::create_symlink(elsewhere.Put("same", whole), set / path);
    EXPECT_THAT(set.Problems(), ElementsAre(path + ": a link, folder or device, must be a file"));
  }
}

// Another picture under right hashes of its file: only decoding shows it, as where a tool has rewritten both.
TEST(Verify, Decodes) {
  const PictureSet set(LayoutKind::kSequence, kPng8);
  const std::string path = "clips/000002/turb/0001.png";
  const auto bytes_as = [&](const std::vector<uint8_t>& bytes) {
    WriteFile(set / path, bytes);
    set.ChangeLines([&](Json& line) {
      for (Json& file : line["files"])
        if (file["path"] == path) file.update({{"bytes", bytes.size()}, {"sha256", Sha256Hex(bytes)}});
    });
    return set.Problems();
  };
  EXPECT_THAT(bytes_as(EncodePng(RandomImage({7, 5}, 3, 99), 8)),
              ElementsAre(path + ": damaged: its pixels are not those of the manifest"));
  EXPECT_THAT(bytes_as(std::vector<uint8_t>(100, 'x')),
              ElementsAre(testing::StartsWith(path + ": can't be decoded: ")));
}

TEST(MoveToSurplus, LosesNothing) {
  const TempFolder folder;
  folder.Put("a/b/file", "1");
  EXPECT_EQ(MoveToSurplus(folder.path(), "a/b/file"), ".surplus/a/b/file");
  EXPECT_FALSE(fs::exists(folder / "a"));  // empty folders go
  folder.Put("a/b/file", "2");
  folder.Put("a/other", "3");
  EXPECT_EQ(MoveToSurplus(folder.path(), "a/b/file"), ".surplus.1/a/b/file");
  EXPECT_TRUE(fs::exists(folder / "a/other"));
  folder.Put("c", "4");
  EXPECT_EQ(MoveToSurplus(folder.path(), "c"), ".surplus/c");
  folder.Put("c/d", "5");  // a file lies where the folder would be
  EXPECT_EQ(MoveToSurplus(folder.path(), "c/d"), ".surplus.1/c/d");
  EXPECT_EQ(ReadFile(folder / ".surplus/a/b/file"), std::vector<uint8_t>{'1'});
  EXPECT_EQ(ReadFile(folder / ".surplus.1/a/b/file"), std::vector<uint8_t>{'2'});
}

// Neither what a link leads to nor anything beyond the folder is touched.
TEST(MoveToSurplus, MovesLinksThemselves) {
  const TempFolder folder, elsewhere;
  elsewhere.Put("precious", "x");
  fs::create_symlink(elsewhere.path(), folder / "link");
  fs::create_symlink(elsewhere.path(), folder / ".surplus");
  EXPECT_EQ(MoveToSurplus(folder.path(), "link"), ".surplus.1/link");
  EXPECT_TRUE(fs::is_symlink(folder / ".surplus.1/link"));
  EXPECT_EQ(Tree(elsewhere.path()).size(), 1u);
}

}  // namespace
}  // namespace shimmer::dataset
