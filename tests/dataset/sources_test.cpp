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
  EXPECT_EQ(Find({"clips/v.mp4"}), Patterns{"clips/v.mp4"});  // asked for by name
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

TEST_F(Sources, AListHasOnePatternALine) {
  folder_.Put("a.txt", "# two of them\n\n  \nphotos/f2.png\nphotos/f1.png");
  folder_.Put("b.txt", "photos/sub\nphotos/[a-b].*\nphotos/sub/c.tif\n" + (folder_ / "clips/w.jpg").string());
  folder_.Put("windows.TXT", "\xEF\xBB\xBF\tphotos/f1.png \r\n\r\n#\r\nphotos/f2.png\r\n");
  folder_.Put("clips.txt", "clips");
  folder_.Put("photos/odd #1.png", "x");
  folder_.Put("hash.txt", "photos/odd #1.png");
  const Patterns two = {"photos/f1.png", "photos/f2.png"};
  EXPECT_EQ(Find({"a.txt"}), two);
  EXPECT_EQ(Find({"windows.TXT"}), two);
  EXPECT_EQ(Find({"b.txt"}), (Patterns{"clips/w.jpg", "photos/a.png", "photos/b.JPG", "photos/sub/c.tif",
                                       "photos/sub/deep/d.exr"}));
  EXPECT_EQ(Find({"photos/a.png", "a.txt", "a.txt", "photos/f1.png"}),
            (Patterns{"photos/a.png", "photos/f1.png", "photos/f2.png"}));
  EXPECT_EQ(Find({(folder_ / "clips.txt").string()}, FileKind::kVideo),
            (Patterns{"clips/v.mp4", "clips/w.avi"}));
  EXPECT_EQ(Find({"hash.txt"}), Patterns{"photos/odd #1.png"});
}

TEST_F(Sources, AListsPatternsCountFromItsFolderFirst) {
  folder_.Put("f1.png", "x");
  folder_.Put("photos/list.txt", "f1.png\nclips/w.jpg");
  EXPECT_EQ(Find({"photos/list.txt"}), (Patterns{"clips/w.jpg", "photos/f1.png"}));
  // The list itself is looked up as any pattern is.
  const Patterns pattern = {"list.txt"};
  const Paths bases = {folder_ / "empty", folder_ / "photos", folder_.path()};
  EXPECT_EQ(Relative(FindFiles(pattern, bases, FileKind::kPicture)),
            (Patterns{"clips/w.jpg", "photos/f1.png"}));
}

TEST_F(Sources, AListOfSequences) {
  for (const std::string name : {"run/in7.png", "run/in8.png", "padded/in00.png"}) folder_.Put(name, "x");
  folder_.Put("runs/list.txt", "padded\r\n../run/in%d.png\r\n");
  const Patterns patterns = {"runs/list.txt"};
  EXPECT_EQ(Relative(FindSequences(patterns, Paths{folder_.path()})), (Patterns{"padded", "run/in%d.png"}));
}

TEST_F(Sources, WhatIsWrongWithAListIsNamedByItsLine) {
  folder_.Put("sub/nothing.txt", "# of these\nphotos/a.png\n\nno.png\n");
  folder_.Put("sub/nested.txt", "photos/a.png\nnothing.txt\n");
  folder_.Put("sub/empty.txt", "");
  folder_.Put("sub/comments.txt", "# one\n\n  \n# two\n");
  folder_.Put("sub/utf16.txt", std::string("p\0h\0", 4));
  fs::create_directory(folder_ / "sub/folder.txt");
  const Paths bases = {folder_.path(), folder_ / "clips"};
  const std::string places = folder_.path().string() + " and " + (folder_ / "clips").string();
  const auto expect = [&](const std::string& list, const std::string& message) {
    const Patterns patterns = {"photos", list};
    EXPECT_EQ(ErrorOf<std::runtime_error>([&] { FindFiles(patterns, bases, FileKind::kPicture); }), message);
    EXPECT_EQ(ErrorOf<std::runtime_error>([&] { FindSequences(patterns, bases); }).empty(), false);
  };
  const std::string sub = (folder_ / "sub/").string();
  expect("sub/nothing.txt", sub + "nothing.txt:4: 'no.png': nothing found; looked in " +
                                (folder_ / "sub").string() + " and " + places +
                                "; a # before a line skips it");
  expect("sub/nested.txt",
         sub + "nested.txt:2: 'nothing.txt': lists don't nest, must be a file, a folder or a pattern");
  for (const std::string name : {"empty.txt", "comments.txt"})
    expect("sub/" + name,
           sub + name + ": no pattern in it, must have one a line (a line that starts with # is none)");
  expect("sub/utf16.txt", sub + "utf16.txt: not a text, must be one in UTF-8 with one pattern a line");
  for (const std::string name : {"gone.txt", "*.txt", "folder.txt"})
    expect("sub/" + name,
           "'sub/" + name +
               "': no such list, a name that ends in .txt must be that of a text file with one "
               "pattern a line; looked in " +
               places);
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
