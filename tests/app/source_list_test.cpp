// The list of sources as a run makes it at its start: hashes on all threads, remembered, and given up on
// request.
#include "sim/app/source_list.h"

#include <chrono>

#include "sim/dataset/sha256.h"
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

std::string HashOfText(const std::string& text) { return dataset::Sha256Hex(dataset::AsBytes(text)); }

// A hundred files that name themselves, last changed long ago.
void PutPhotos(const TempFolder& folder) {
  for (int i = 0; i < 100; ++i) {
    const std::string name = "in/" + std::to_string(i) + ".jpg";
    fs::last_write_time(folder.Put(name, name), fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
}

SourceList Photos(const TempFolder& folder, const std::atomic<bool>& stop = dataset::kNeverStop) {
  SourceParams source;
  source.images = {"in"};
  return SourceList::Find(source, folder.path(), folder / "set", stop);
}

TEST(SourceList, EachFileHasItsOwnHashInTheOrderOfNames) {
  const TempFolder folder;
  PutPhotos(folder);
  const SourceList list = Photos(folder);
  ASSERT_EQ(list.items().size(), 100u);
  for (size_t i = 0; i < 100; ++i) {
    const Json record = list.Record(i);
    EXPECT_EQ(record.at("sha256"), HashOfText(record.at("path")));
    EXPECT_EQ(folder / record.at("path").get<std::string>(), list.items()[i]);
    EXPECT_TRUE(i == 0 || list.Record(i - 1).at("path") < record.at("path"));
  }
}

TEST(SourceList, OfASequenceHashesItsFramesInTheirOrder) {
  const TempFolder folder;
  PutPhotos(folder);
  std::string hashes;
  for (int i = 0; i < 100; ++i) hashes += HashOfText("in/" + std::to_string(i) + ".jpg");
  SourceParams source;
  source.sequence = {"in"};
  const SourceList list = SourceList::Find(source, folder.path(), folder / "set");
  EXPECT_EQ(list.Record(0).at("sha256"), HashOfText(hashes));
}

TEST(SourceList, RemembersHashesInTheDataSetsFolder) {
  const TempFolder folder;
  PutPhotos(folder);
  SourceList first = Photos(folder);
  first.Remember(folder / "set");  // which is not there: no error, and it is not made
  EXPECT_FALSE(fs::exists(folder / "set"));

  fs::create_directory(folder / "set");
  SourceList second = Photos(folder);
  second.Remember(folder / "set");
  EXPECT_EQ(NamesIn(folder / "set"), (std::set<std::string>{".sources"}));
  const fs::path photo = folder / "in/7.jpg";
  const auto time = fs::last_write_time(photo);
  folder.Put("in/7.jpg", "IN/7.JPG");
  fs::last_write_time(photo, time);
  EXPECT_EQ(Photos(folder).Records(), second.Records());  // it was not read
  fs::last_write_time(photo, time + std::chrono::seconds(1));
  EXPECT_NE(Photos(folder).Records(), second.Records());
}

TEST(SourceList, IsGivenUpOnceThePersonAsks) {
  const TempFolder folder;
  PutPhotos(folder);
  const std::atomic<bool> stop{true};
  EXPECT_THROW(Photos(folder, stop), dataset::Interrupted);
}

}  // namespace
}  // namespace shimmer::app
