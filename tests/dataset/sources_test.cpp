#include "sim/dataset/sources.h"

#include <algorithm>

#include "sim/dataset/glob.h"
#include "sim/dataset/numbered_name.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
using Patterns = std::vector<std::string>;

class Sources : public ::testing::Test {
 protected:
  Sources() {
    for (const std::string name :
         {"photos/b.JPG", "photos/a.png", "photos/notes.txt", "photos/.hidden.png", "photos/sub/c.tif",
          "photos/sub/deep/d.exr", "photos/sub/.git/e.png", "photos/f1.png", "photos/f2.png",
          "photos/odd[1].png", "clips/v.mp4", "clips/w.avi", "clips/w.jpg"})
      folder_.Put(name, "x");
    fs::create_directory(folder_ / "empty");
  }

  // Found below the folder, as names relative to it.
  Patterns Find(const Patterns& patterns, FileKind kind = FileKind::kPicture) const {
    return Relative(FindFiles(patterns, Paths{folder_.path()}, kind));
  }
  Patterns Relative(const Paths& found) const {
    Patterns names;
    for (const fs::path& path : found) names.push_back(path.lexically_relative(folder_.path()).string());
    return names;
  }

  TempFolder folder_;
};

TEST_F(Sources, AFile) {
  EXPECT_EQ(Find({"photos/a.png"}), Patterns{"photos/a.png"});
  EXPECT_EQ(Find({"photos/notes.txt"}), Patterns{"photos/notes.txt"});  // asked for by name
  EXPECT_EQ(Find({"photos/odd[1].png"}), Patterns{"photos/odd[1].png"});
  EXPECT_EQ(Find({(folder_ / "photos/a.png").string()}), Patterns{"photos/a.png"});
}

TEST_F(Sources, AFolderIsEveryPictureBelow) {
  const Patterns all = {"photos/a.png",      "photos/b.JPG",     "photos/f1.png",        "photos/f2.png",
                        "photos/odd[1].png", "photos/sub/c.tif", "photos/sub/deep/d.exr"};
  EXPECT_EQ(Find({"photos"}), all);
  EXPECT_EQ(Find({"photos/"}), all);
  EXPECT_EQ(Find({"clips"}, FileKind::kVideo), (Patterns{"clips/v.mp4", "clips/w.avi"}));
  EXPECT_EQ(Find({"clips"}), Patterns{"clips/w.jpg"});
}

TEST_F(Sources, Globs) {
  EXPECT_EQ(Find({"photos/*.png"}),
            (Patterns{"photos/a.png", "photos/f1.png", "photos/f2.png", "photos/odd[1].png"}));
  EXPECT_EQ(Find({"photos/f?.png"}), (Patterns{"photos/f1.png", "photos/f2.png"}));
  EXPECT_EQ(Find({"photos/f[2-9].png"}), Patterns{"photos/f2.png"});
  EXPECT_EQ(Find({"photos/**/*.[te]*"}),
            (Patterns{"photos/notes.txt", "photos/sub/c.tif", "photos/sub/deep/d.exr"}));
  EXPECT_EQ(Find({"**/d.exr"}), Patterns{"photos/sub/deep/d.exr"});
  EXPECT_EQ(Find({"*/sub/**"}), (Patterns{"photos/sub/c.tif", "photos/sub/deep/d.exr"}));
  EXPECT_EQ(Find({"**/sub/**/c.tif"}), Patterns{"photos/sub/c.tif"});  // ** is no folder, too
  EXPECT_EQ(Find({"photos/.h*"}), Patterns{"photos/.hidden.png"});
}

TEST_F(Sources, SortedByBytesAndWithoutRepeats) {
  EXPECT_EQ(Find({"photos/f2.png", "photos/f*.png", "photos/sub/../f1.png", "clips/w.jpg"}),
            (Patterns{"clips/w.jpg", "photos/f1.png", "photos/f2.png"}));
}

TEST_F(Sources, TheFirstBaseThatHasAMatch) {
  const Patterns pattern = {"a.png"};
  folder_.Put("a.png", "x");
  const auto found = [&](const Paths& bases) {
    return Relative(FindFiles(pattern, bases, FileKind::kPicture));
  };
  EXPECT_EQ(found({folder_ / "empty", folder_ / "photos", folder_.path()}), Patterns{"photos/a.png"});
  EXPECT_EQ(found({folder_.path(), folder_ / "photos"}), Patterns{"a.png"});
}

TEST_F(Sources, NothingFoundNamesThePatternAndThePlaces) {
  for (const std::string pattern : {"no.png", "no/*.png", "no/**", "empty", "empty/*"}) {
    const Patterns patterns = {"photos", pattern};
    const Paths bases = {folder_.path(), folder_ / "clips"};
    const std::string error =
        ErrorOf<std::runtime_error>([&] { FindFiles(patterns, bases, FileKind::kPicture); });
    EXPECT_TRUE(Contains(error, "'" + pattern + "'")) << error;
    EXPECT_TRUE(Contains(error, folder_.path().string() + " and " + (folder_ / "clips").string())) << error;
  }
}

TEST_F(Sources, LinksAreFollowedAndLoopsEnd) {
  fs::create_directory_symlink(folder_ / "photos/sub", folder_ / "empty/link");
  fs::create_directory_symlink(folder_ / "empty", folder_ / "empty/loop");
  fs::create_symlink(folder_ / "gone.png", folder_ / "empty/broken.png");
  EXPECT_EQ(Find({"empty/**/*.tif"}), Patterns{"empty/link/c.tif"});
  // A link to nothing is a source that fails with a clear error when it is read, not one that is passed over.
  EXPECT_EQ(Find({"empty"}), (Patterns{"empty/broken.png", "empty/link/c.tif", "empty/link/deep/d.exr"}));
}

TEST_F(Sources, Sequences) {
  for (const int i : {7, 8, 9, 10}) folder_.Put("run/in" + std::to_string(i) + ".png", "x");
  for (const int i : {0, 1, 2}) folder_.Put("padded/in00" + std::to_string(i) + ".png", "x");
  const Paths bases = {folder_.path()};
  const auto found = [&](const Patterns& patterns) { return Relative(FindSequences(patterns, bases)); };
  EXPECT_EQ(found({"run/in%d.png"}), Patterns{"run/in%d.png"});
  EXPECT_EQ(found({"run", "padded"}), (Patterns{"padded", "run"}));
  EXPECT_EQ(found({"[rp]*d"}), Patterns{"padded"});
  EXPECT_THROW(found({"run/in%03d.png"}), std::runtime_error);
  EXPECT_THROW(found({"none"}), std::runtime_error);

  EXPECT_EQ(Relative(SequenceFiles(folder_ / "run/in%d.png")),
            (Patterns{"run/in7.png", "run/in8.png", "run/in9.png", "run/in10.png"}));
  EXPECT_EQ(Relative(SequenceFiles(folder_ / "run")), Relative(SequenceFiles(folder_ / "run/in%d.png")));
  EXPECT_EQ(SequenceFiles(folder_ / "padded/in%03d.png").size(), 3u);
  EXPECT_THROW(SequenceFiles(folder_ / "padded/in%d.png"),
               std::runtime_error);  // in000 is not what %d writes
}

TEST_F(Sources, AGapInTheNumbersNamesTheMissingFile) {
  for (const int i : {3, 4, 6}) folder_.Put("gap/in00" + std::to_string(i) + ".png", "x");
  const std::string error = ErrorOf<std::runtime_error>([&] { SequenceFiles(folder_ / "gap/in%03d.png"); });
  EXPECT_TRUE(Contains(error, (folder_ / "gap/in005.png").string())) << error;
  EXPECT_EQ(SequenceFiles(folder_ / "gap").size(), 3u);  // every picture of a folder, whatever its numbers
}

TEST_F(Sources, AFolderIsSortedByNumberThenBytes) {
  for (const std::string name :
       {"f10.png", "f9.png", "f010.png", "none.png", "b2.png", "a2.png", "readme.txt",
        "f99999999999999999999999.png", "f100000000000000000000000.png"})
    folder_.Put("mixed/" + name, "x");
  folder_.Put("mixed/below/f1.png", "x");
  const std::string in = "mixed/";
  EXPECT_EQ(
      Relative(SequenceFiles(folder_ / "mixed")),
      (Patterns{in + "none.png", in + "a2.png", in + "b2.png", in + "f9.png", in + "f010.png", in + "f10.png",
                in + "f99999999999999999999999.png", in + "f100000000000000000000000.png"}));
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { SequenceFiles(folder_ / "empty"); }), "no pictures"));
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { SequenceFiles(folder_ / "photos/a.png"); }),
                       "not a sequence"));
}

TEST(NumberedName, WhatItMatches) {
  const auto name = NumberedName::Parse("in%03d.jpg");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->Of(7), "in007.jpg");
  EXPECT_EQ(name->Of(1234), "in1234.jpg");
  EXPECT_EQ(name->NumberOf("in007.jpg"), 7);
  EXPECT_EQ(name->NumberOf("in1234.jpg"), 1234);
  for (const std::string other :
       {"in07.jpg", "in0007.jpg", "in007.png", "out007.jpg", "in.jpg", "inx07.jpg", "in-07.jpg"})
    EXPECT_FALSE(name->NumberOf(other)) << other;
  for (const std::string pattern :
       {"in.jpg", "in%s.jpg", "in%3d.jpg", "in%d%d.jpg", "100%", "in%0d.jpg", "in%099d.jpg"})
    EXPECT_FALSE(NumberedName::Parse(pattern)) << pattern;
}

}  // namespace
}  // namespace shimmer::dataset
