#include "sim/dataset/files.h"

#include <fcntl.h>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

TEST(Files, WhatIsWrittenIsThere) {
  const TempFolder folder;
  const std::string text(300000, 'x');  // more than is read at once
  WriteFile(folder / "a", AsBytes(text));
  WriteFile(folder / "a", AsBytes(text));  // again: over the old one
  const std::vector<uint8_t> back = ReadFile(folder / "a");
  EXPECT_EQ(std::string(back.begin(), back.end()), text);
  EXPECT_EQ(ReadStart(folder / "a", 5).size(), 5u);
  WriteFile(folder / "a", AsBytes("b"));
  EXPECT_EQ(ReadFile(folder / "a").size(), 1u);
  EXPECT_EQ(ReadStart(folder / "a", 5).size(), 1u);
}

TEST(Files, ManyAtOnce) {
  const TempFolder folder;
  // More than are held open at a time.
  std::vector<std::string> texts;
  for (int i = 0; i < 150; ++i) texts.push_back(std::to_string(i));
  std::vector<FileToWrite> files;
  for (const std::string& text : texts) files.push_back({folder / text, AsBytes(text)});
  WriteFiles(files);
  for (const std::string& text : texts) EXPECT_EQ(ReadFile(folder / text).size(), text.size());
}

TEST(Files, ErrorsNameThePathAndTheReason) {
  const TempFolder folder;
  folder.Put("file", "x");
  const std::string error = ErrorOf<std::runtime_error>([&] { WriteFile(folder / "no/x", AsBytes("x")); });
  EXPECT_TRUE(Contains(error, (folder / "no/x").string()) && Contains(error, "No such file or directory"))
      << error;
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { WriteFile(folder / "file/x", AsBytes("x")); }),
                       "Not a directory"));
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { MakeFolders(folder / "file/x"); }), "can't be made"));
  EXPECT_TRUE(
      Contains(ErrorOf<std::runtime_error>([&] { Rename(folder / "no", folder / "x"); }), "No such file"));
  EXPECT_THROW(SyncFolder(folder / "file"), std::runtime_error);
}

TEST(Files, AtomicallyLeavesTheOldOneOrTheNew) {
  const TempFolder folder;
  WriteFileAtomically(folder / "a", AsBytes("old"));
  WriteFileAtomically(folder / "a", AsBytes("newer"));
  EXPECT_EQ(ReadFile(folder / "a").size(), 5u);
  // /dev/full is always full: the write goes nowhere, and says so.
  std::filesystem::create_symlink("/dev/full", folder / "a.new");
  const std::string error =
      ErrorOf<std::runtime_error>([&] { WriteFileAtomically(folder / "a", AsBytes("third")); });
  EXPECT_TRUE(Contains(error, "No space left on device")) << error;
  EXPECT_EQ(ReadFile(folder / "a").size(), 5u);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.new"));
}

TEST(Files, FoldersAreMadeWithTheirParentsAndAgain) {
  const TempFolder folder;
  MakeFolders(folder / "a/b/c");
  MakeFolders(folder / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  RemoveAll(folder / "a");
  RemoveAll(folder / "a");
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

TEST(Files, OneLockAtATime) {
  const TempFolder folder;
  {
    FileHandle first(folder / "lock", O_CREAT | O_RDWR), second(folder / "lock", O_CREAT | O_RDWR);
    EXPECT_EQ(first.TryLock(), Lock::kHeld);
    EXPECT_EQ(second.TryLock(), Lock::kTaken);
  }
  FileHandle third(folder / "lock", O_CREAT | O_RDWR);
  EXPECT_EQ(third.TryLock(), Lock::kHeld);  // gone with its holder
}

TEST(Files, CutToASize) {
  const TempFolder folder;
  folder.Put("a", "abcdef");
  FileHandle file(folder / "a", O_WRONLY | O_APPEND);
  file.Truncate(2);
  file.WriteAll(AsBytes("X"));
  file.Close();
  EXPECT_EQ(ReadFile(folder / "a"), (std::vector<uint8_t>{'a', 'b', 'X'}));
}

}  // namespace
}  // namespace shimmer::dataset
