// Number 14 of the fault list: silent rot. Harm is done to files of a data set chosen at random; verifying
// must name each of them and nothing else, and repairing must make the set what it was, byte by byte, and
// touch no other file.
#pragma once

#include <sys/stat.h>

#include <map>
#include <random>
#include <set>
#include <utility>

#include "tests/app/sets.h"

namespace shimmer::app {

struct HarmCounts {
  int flipped = 0, deleted = 0, swapped_pairs = 0, truncated = 0, surplus = 0;
};

// What stat says of every file, hidden ones left out: its place on disk and when it was written.
inline std::map<std::string, std::pair<uint64_t, int64_t>> Inodes(const fs::path& folder) {
  std::map<std::string, std::pair<uint64_t, int64_t>> inodes;
  for (const auto& [name, content] : Tree(folder)) {
    struct stat status = {};
    stat((folder / name).c_str(), &status);
    inodes[name] = {status.st_ino, status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec};
  }
  return inodes;
}

// Files that were replaced or written to, the manifest left out.
inline Words Touched(const std::map<std::string, std::pair<uint64_t, int64_t>>& before,
                     const fs::path& folder) {
  const auto now = Inodes(folder);
  Words names;
  for (const auto& [name, inode] : before)
    if (name != "manifest.jsonl" && (!now.contains(name) || now.at(name) != inode)) names.push_back(name);
  return names;
}

class Harm {
 public:
  // Of `set`, which is whole. The same seed does the same.
  Harm(fs::path set, uint32_t seed)
      : set_(std::move(set)), random_(seed), before_(Tree(set_)), inodes_(Inodes(set_)) {
    std::set<std::string> paths;
    const dataset::DatasetReader reader(set_);
    reader.manifest().ForEachLine([&](int64_t, const Json& line) {
      for (const dataset::StoredFile& file : dataset::FilesOfLine(line)) paths.insert(file.path);
    });
    files_.assign(paths.begin(), paths.end());
    std::ranges::shuffle(files_, random_);
  }

  void Do(const HarmCounts& counts) {
    for (int i = 0; i < counts.flipped; ++i) {
      const std::string path = Take();
      Change(path,
             [&](std::string& bytes) { bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8)); });
      harmed_[path] = "damaged: ";
    }
    for (int i = 0; i < counts.deleted; ++i) {
      const std::string path = Take();
      fs::remove(set_ / path);
      harmed_[path] = "missing";
    }
    for (int i = 0; i < counts.truncated; ++i) {
      const std::string path = Take();
      Change(path, [&](std::string& bytes) { bytes.resize(Below(bytes.size())); });
      harmed_[path] = "truncated: ";
    }
    for (int i = 0; i < counts.swapped_pairs; ++i) {
      const std::string a = Take();
      std::string b = Take();
      while (before_[a] == before_[b]) b = Take();  // two frames may be the same
      fs::rename(set_ / a, set_ / "swap");
      fs::rename(set_ / b, set_ / a);
      fs::rename(set_ / "swap", set_ / b);
      harmed_[a] = kSwapped + b;
      harmed_[b] = kSwapped + a;
    }
    for (int i = 0; i < counts.surplus; ++i) {
      const std::string places[] = {"notes.txt", "stray/deep/file",
                                    fs::path(files_[0]).parent_path() / ".hidden", files_[0] + ".bak"};
      const std::string path = std::to_string(i / 4) + "/" + places[i % 4];
      const std::string name = i < 4 ? places[i % 4] : path;
      fs::create_directories((set_ / name).parent_path());
      dataset::WriteFile(set_ / name, dataset::AsBytes(name));
      surplus_.push_back(name);
      harmed_[name] = "surplus: ";
    }
  }

  // Each harm is one line of what verify has printed, and there is no other but for the summary.
  void ExpectFound(const Ran& ran) const {
    EXPECT_EQ(ran.exit_code, 1) << ran.err;
    std::istringstream lines(ran.out);
    std::map<std::string, std::string> left = harmed_;
    std::string line, last;
    while (std::getline(lines, line)) {
      if (!last.empty()) ExpectIsHarm(last, left);
      last = line;
    }
    EXPECT_THAT(last, testing::HasSubstr(std::to_string(harmed_.size()) + " problems"));
    EXPECT_EQ(left, (std::map<std::string, std::string>{})) << "not found";
  }

  // The set is what it was, what was too much lies in .surplus, and what was whole was not touched.
  void ExpectUndone() const {
    EXPECT_THAT(Differing(Tree(set_), before_), testing::IsEmpty());
    for (const std::string& name : Touched(inodes_, set_)) EXPECT_TRUE(harmed_.contains(name)) << name;
    for (const std::string& name : surplus_) EXPECT_EQ(ReadText(set_ / ".surplus" / name), name);
    // None is left empty.
    for (const auto& entry : fs::recursive_directory_iterator(set_))
      EXPECT_FALSE(entry.is_directory() && fs::is_empty(entry)) << entry.path();
  }

  size_t size() const { return harmed_.size(); }

 private:
  size_t Below(size_t end) { return std::uniform_int_distribution<size_t>(0, end - 1)(random_); }

  std::string Take() {
    if (next_ == files_.size()) throw std::runtime_error("the set has too few files for so much harm");
    return files_[next_++];
  }

  template <class Call>
  void Change(const std::string& path, const Call& call) {
    std::string bytes = before_[path];
    call(bytes);
    dataset::WriteFile(set_ / path, dataset::AsBytes(bytes));
  }

  // A bit that was flipped in a tar may be told of the member that it lies in; bytes that several files have
  // may be told to be any of theirs.
  void ExpectIsHarm(const std::string& line, std::map<std::string, std::string>& left) const {
    const size_t colon = line.find(": ");
    std::string name = line.substr(0, colon);
    if (const size_t tar = name.find(".tar/"); tar != std::string::npos) name.resize(tar + 4);
    const auto harm = left.find(name);
    ASSERT_TRUE(harm != left.end()) << line;
    const std::string what = line.substr(colon + 2);
    if (harm->second.starts_with(kSwapped) && what.starts_with(kSwapped)) {
      EXPECT_EQ(before_.at(what.substr(kSwapped.size())), before_.at(harm->second.substr(kSwapped.size())))
          << line;
    } else {
      EXPECT_TRUE(what.starts_with(harm->second)) << line;
    }
    left.erase(harm);
  }

  const std::string kSwapped = "swapped: holds what belongs to ";
  fs::path set_;
  std::mt19937 random_;
  std::map<std::string, std::string> before_;
  std::map<std::string, std::pair<uint64_t, int64_t>> inodes_;
  std::vector<std::string> files_, surplus_;
  size_t next_ = 0;
  std::map<std::string, std::string> harmed_;  // what verify must say of each
};

}  // namespace shimmer::app
