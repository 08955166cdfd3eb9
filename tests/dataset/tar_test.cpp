#include "sim/dataset/tar.h"

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// Sizes at the edges of a tar's blocks of 512 bytes.
const std::vector<size_t> kSizes = {0, 1, 511, 512, 513, 100'000};

std::vector<TarMember> Members(const TempFolder& folder) {
  std::vector<TarMember> members;
  for (const size_t size : kSizes) {
    const std::string name = "000001.turb." + std::to_string(size) + ".png";
    std::string text;
    for (size_t i = 0; i < size; ++i) text += static_cast<char>('a' + (i + size) % 23);
    members.push_back({name, folder.Put("in/" + name, text), static_cast<int64_t>(size)});
  }
  return members;
}

TEST(Tar, MembersLieWhereItSaysTheyDo) {
  const TempFolder folder;
  const std::vector<TarMember> members = Members(folder);
  const fs::path tar = folder / "a.tar";
  const std::vector<int64_t> offsets = WriteTar(tar, members);
  const std::vector<TarEntry> entries = TarEntries(tar);
  ASSERT_EQ(entries.size(), members.size());
  int64_t bytes = 0;
  for (size_t i = 0; i < members.size(); ++i) {
    EXPECT_EQ(entries[i].name, members[i].name);
    EXPECT_EQ(entries[i].offset, offsets[i]);
    EXPECT_EQ(entries[i].bytes, members[i].bytes);
    EXPECT_EQ(ReadPart(tar, static_cast<uint64_t>(offsets[i]), static_cast<size_t>(members[i].bytes)),
              ReadFile(members[i].place));
    bytes += TarBytes(members[i].bytes);
  }
  EXPECT_EQ(static_cast<int64_t>(fs::file_size(tar)), WholeTarBytes(bytes));
  EXPECT_LE(WholeTarBytes(bytes), bytes + kTarEndBytes);
  EXPECT_EQ(FirstTarMember(tar), members[0].name);
}

TEST(Tar, TheSameMembersGiveTheSameBytes) {
  const TempFolder folder;
  const std::vector<TarMember> members = Members(folder);
  WriteTar(folder / "a.tar", members);
  for (const TarMember& member : members)  // dates and rights of the files are not the tar's
    fs::permissions(member.place, fs::perms::owner_read | fs::perms::owner_write);
  WriteTar(folder / "b.tar", members);
  EXPECT_EQ(ReadFile(folder / "a.tar"), ReadFile(folder / "b.tar"));
}

// As GNU tar sees it, where there is one.
TEST(Tar, IsReadByTar) {
  const TempFolder folder;
  WriteTar(folder / "a.tar", Members(folder));
  fs::create_directory(folder / "out");
  const std::string command =
      "tar -xf '" + (folder / "a.tar").string() + "' -C '" + (folder / "out").string() + "'";
  if (std::system("tar --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no tar on this machine";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const TarMember& member : Members(folder))
    EXPECT_EQ(ReadFile(folder / ("out/" + member.name)), ReadFile(member.place));
}

TEST(Tar, WhatIsWrong) {
  const TempFolder folder;
  const std::vector<TarMember> members = Members(folder);
  EXPECT_THROW(WriteTar(folder / "no/a.tar", members), std::runtime_error);
  std::vector<TarMember> other = members;
  other[1].bytes = 2;  // not what its file has
  EXPECT_THROW(WriteTar(folder / "a.tar", other), std::runtime_error);
  other[1] = {std::string(101, 'x'), members[1].place, 1};
  EXPECT_THROW(WriteTar(folder / "a.tar", other), std::invalid_argument);
  EXPECT_THROW(TarEntries(folder / "absent.tar"), std::runtime_error);
  EXPECT_THROW(TarEntries(folder.Put("text.tar", std::string(2000, 'x'))), std::runtime_error);
  WriteTar(folder / "whole.tar", members);
  const std::vector<uint8_t> bytes = ReadFile(folder / "whole.tar");
  EXPECT_THROW(TarEntries(folder.Put("cut.tar", std::span(bytes).first(60'000))), std::runtime_error);
}

// A tar of Members, and its bytes.
struct Written {
  TempFolder folder;
  fs::path tar;
  std::vector<TarEntry> members;
  std::vector<uint8_t> whole;

  Written() : tar(folder / "a.tar") {
    WriteTar(tar, Members(folder));
    members = TarEntries(tar);
    whole = ReadFile(tar);
  }
};

TEST(TarDamage, IsFoundWhereNoMemberIs) {
  const Written written;
  EXPECT_EQ(TarDamage(written.tar, written.members), std::nullopt);
  const auto damage_at = [&](size_t place) {
    std::vector<uint8_t> bytes = written.whole;
    bytes.at(place) ^= 4;
    WriteFile(written.tar, bytes);
    return TarDamage(written.tar, written.members);
  };
  // The first header's name and checksum, and that of the second member, of one byte; what fills up its
  // block; the blocks at the end.
  for (const size_t place :
       {size_t{0}, size_t{150}, size_t{512 + 150}, size_t{1025}, size_t{1535}, written.whole.size() - 1})
    EXPECT_EQ(damage_at(place), static_cast<int64_t>(place));
  EXPECT_EQ(damage_at(1024), std::nullopt);  // the member's own
  damage_at(150);
  EXPECT_EQ(FirstTarMember(written.tar), std::nullopt);
}

TEST(TarDamage, IsALengthThatItHadNot) {
  const Written written;
  const auto length = static_cast<int64_t>(written.whole.size());
  std::vector<uint8_t> bytes = written.whole;
  bytes.push_back(0);
  WriteFile(written.tar, bytes);
  EXPECT_EQ(TarDamage(written.tar, written.members), length);
  WriteFile(written.tar, std::span(written.whole).first(written.whole.size() - 1));
  EXPECT_EQ(TarDamage(written.tar, written.members), length - 1);
  WriteFile(written.tar, std::span(written.whole).first(1000));
  EXPECT_THROW(TarDamage(written.tar, written.members), std::runtime_error);
}

}  // namespace
}  // namespace shimmer::dataset
