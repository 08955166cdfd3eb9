// Hashes are of the bytes that are there, whatever is remembered; and what is remembered is not read again.
#include "sim/dataset/hash_memory.h"

#include <chrono>
#include <set>

#include "sim/dataset/interrupted.h"
#include "sim/dataset/sha256.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;

fs::file_time_type Ago(std::chrono::nanoseconds time) { return fs::file_time_type::clock::now() - time; }

fs::path PutAt(const TempFolder& folder, const std::string& name, const std::string& text,
               fs::file_time_type time) {
  const fs::path path = folder.Put(name, text);
  fs::last_write_time(path, time);
  return path;
}

std::string HashOfText(const std::string& text) { return Sha256Hex(AsBytes(text)); }

// As a run does that knows `folder`; remembers in it what it found.
std::string HashInARun(const fs::path& file, const fs::path& folder) {
  HashMemory memory(folder);
  const std::string hash = memory.HashOf(file, kNeverStop);
  memory.Write(folder);
  return hash;
}

TEST(HashMemory, DoesNotReadAgainWhatIsAsItWas) {
  const TempFolder folder;
  const auto time = Ago(hours(1));
  const fs::path file = PutAt(folder, "a.jpg", "first", time);
  EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("first"));
  PutAt(folder, "a.jpg", "other", time);  // which nobody could see who does not read it
  EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("first"));
  PutAt(folder, "a.jpg", "other", time + std::chrono::nanoseconds(1000));
  EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("other"));
  PutAt(folder, "a.jpg", "longer", time + std::chrono::nanoseconds(1000));
  EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("longer"));
}

TEST(HashMemory, KnowsAFileFromAnyWorkingFolder) {
  const TempFolder folder;
  const auto time = Ago(hours(1));
  const fs::path file = PutAt(folder, "in/a.jpg", "first", time);
  HashInARun(file, folder.path());
  PutAt(folder, "in/a.jpg", "other", time);
  EXPECT_EQ(HashInARun(fs::relative(folder / "in/./b/../a.jpg"), folder.path()), HashOfText("first"));
}

// Within the same tick of the clock it might change once more.
TEST(HashMemory, ReadsAgainWhatWasChangedJustBefore) {
  const TempFolder folder;
  for (const auto& time : {Ago(std::chrono::seconds(0)), Ago(-hours(1))}) {
    const fs::path file = PutAt(folder, "a.jpg", "first", time);
    EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("first"));
    PutAt(folder, "a.jpg", "other", time);
    EXPECT_EQ(HashInARun(file, folder.path()), HashOfText("other"));
  }
}

TEST(HashMemory, ForgetsWhatNobodyAskedFor) {
  const TempFolder folder;
  const fs::path a = PutAt(folder, "a.jpg", "a", Ago(hours(1))),
                 b = PutAt(folder, "b.jpg", "b", Ago(hours(1)));
  HashInARun(a, folder.path());
  HashInARun(b, folder.path());
  const std::vector<uint8_t> bytes = ReadFile(folder / kHashMemoryName);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_FALSE(Contains(text, "a.jpg"));
  EXPECT_TRUE(Contains(text, "b.jpg"));
}

TEST(HashMemory, IsWrittenOnlyWhereSomethingChanged) {
  const TempFolder folder;
  const fs::path file = PutAt(folder, "a.jpg", "a", Ago(hours(1)));
  HashInARun(file, folder.path());
  const auto time = Ago(hours(2));
  fs::last_write_time(folder / kHashMemoryName, time);
  HashInARun(file, folder.path());
  EXPECT_EQ(fs::last_write_time(folder / kHashMemoryName), time);
}

// Cut off anywhere, or with any byte changed: what it gives is right, and the next run mends it.
TEST(HashMemory, DamagedItIsNone) {
  const TempFolder folder;
  const auto time = Ago(hours(1));
  const fs::path a = PutAt(folder, "a.jpg", "first", time), b = PutAt(folder, "b.jpg", "second", time);
  HashMemory memory(folder.path());
  for (const fs::path& file : {a, b}) memory.HashOf(file, kNeverStop);
  memory.Write(folder.path());
  const std::vector<uint8_t> whole = ReadFile(folder / kHashMemoryName);
  PutAt(folder, "a.jpg", "other", time);
  for (size_t i = 0; i + 1 < whole.size(); ++i) {  // (of the last newline nothing hangs)
    std::vector<uint8_t> damaged = whole;
    damaged[i] ^= 1;
    for (const auto& bytes : {std::vector(whole.begin(), whole.begin() + i), damaged}) {
      folder.Put(kHashMemoryName, bytes);
      EXPECT_EQ(HashMemory(folder.path()).HashOf(a, kNeverStop), HashOfText("other")) << i;
    }
  }
  HashInARun(a, folder.path());
  PutAt(folder, "a.jpg", "third", time);
  EXPECT_EQ(HashInARun(a, folder.path()), HashOfText("other"));
}

TEST(HashMemory, WithoutAFolderHashesAreReadAnew) {
  const TempFolder folder;
  const fs::path file = PutAt(folder, "a.jpg", "a", Ago(hours(1)));
  EXPECT_EQ(HashInARun(file, folder / "no/such"), HashOfText("a"));
  EXPECT_FALSE(fs::exists(folder / "no"));
}

// JSON can't hold the name; another file's hash is remembered all the same.
TEST(HashMemory, NameThatIsNoUtf8) {
  const TempFolder folder;
  HashMemory memory(folder.path());
  const auto time = Ago(hours(1));
  for (const std::string name : {"caf\xe9.jpg", "b.jpg"})
    EXPECT_EQ(memory.HashOf(PutAt(folder, name, name, time), kNeverStop), HashOfText(name));
  memory.Write(folder.path());
  PutAt(folder, "b.jpg", "other", time);
  EXPECT_EQ(HashInARun(folder / "b.jpg", folder.path()), HashOfText("b.jpg"));
}

TEST(HashMemory, WhatCantBeReadAndWhatIsStopped) {
  const TempFolder folder;
  HashMemory memory(folder.path());
  EXPECT_TRUE(Contains(ErrorOf<std::runtime_error>([&] { memory.HashOf(folder / "no.jpg", kNeverStop); }),
                       "no.jpg: no such file"));
  EXPECT_THROW(memory.HashOf(folder.path(), kNeverStop), std::runtime_error);
  const std::atomic<bool> stop{true};
  EXPECT_THROW(memory.HashOf(folder.Put("a.jpg", "a"), stop), Interrupted);
}

}  // namespace
}  // namespace shimmer::dataset
