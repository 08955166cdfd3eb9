// Small data sets of every layout, and what lies on disk of one, to the last hidden file.
#pragma once

#include <sys/stat.h>

#include "sim/dataset/sha256.h"
#include "tests/app/program.h"

namespace shimmer::app {

inline const std::vector<std::string> kLayouts = {"sequence", "pairs", "restormer", "basicsr", "webdataset"};

// Drawn clips of two frames of 24 x 16, in a millisecond each; a tar holds 9 of them. changes: sections or
// keys that are replaced; of output, keys of it.
inline std::string SetConfig(const std::string& layout, int clips, const Json& changes = Json::object()) {
  Json config = Json::parse(SmallConfig({{"clips", clips},
                                         {"output",
                                          {{"layout", layout},
                                           {"test_fraction", 0.3},
                                           {"frames_per_clip", 2},
                                           {"any_length", true},
                                           {"tar_mb", 1},
                                           {"truth", {"tilt"}}}}}));
  for (const auto& [key, value] : changes.items()) {
    if (key == "output")
      config[key].update(value);
    else
      config[key] = value;
  }
  return config.dump();
}

// Locks, and the memory of the sources' dates.
inline bool IsNoData(const std::string& path) { return path.starts_with(".lock") || path == ".sources"; }

// Every file and folder below a folder with its hash, hidden ones too, but for locks and .sources.
inline std::map<std::string, std::string> WholeTree(const fs::path& folder) {
  std::map<std::string, std::string> tree;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().lexically_relative(folder).string();
    if (IsNoData(path)) continue;
    tree[path] = entry.is_directory() ? "folder" : dataset::Sha256HexOfFile(entry.path());
  }
  return tree;
}

// Names of the files that only one of two trees has, or that are not the same in both.
inline Words Differing(const std::map<std::string, std::string>& a,
                       const std::map<std::string, std::string>& b) {
  Words names;
  for (const auto& [name, content] : a)
    if (!b.contains(name) || b.at(name) != content) names.push_back(name);
  for (const auto& [name, content] : b)
    if (!a.contains(name)) names.push_back(name);
  return names;
}

// What a manifest promises and the disk does not hold: one text a file, empty where all is well.
inline Words BrokenFiles(const fs::path& set) {
  Words broken;
  const dataset::Manifest manifest(dataset::ManifestsIn(set));
  manifest.ForEachLine([&](int64_t clip, const Json& line) {
    if (!manifest.done().contains(clip)) return;
    for (const dataset::StoredFile& file : dataset::FilesOfLine(line)) {
      const fs::path path = set / file.path;
      if (!fs::is_regular_file(path)) {
        broken.push_back(file.name() + " is not there");
        continue;
      }
      const auto bytes =
          dataset::ReadPart(path, static_cast<uint64_t>(file.offset), static_cast<size_t>(file.bytes));
      if (dataset::Sha256Hex(bytes) != file.sha256 ||
          (file.member.empty() && fs::file_size(path) != bytes.size()))
        broken.push_back(file.name() + " is damaged");
    }
  });
  return broken;
}

inline std::set<int64_t> DoneClips(const fs::path& set) {
  return dataset::Manifest(dataset::ManifestsIn(set)).done();
}

// Of the files of clips that are done: what shows that they were not written once more.
inline std::map<std::string, ino_t> InodesOfDone(const fs::path& set) {
  std::map<std::string, ino_t> inodes;
  const dataset::Manifest manifest(dataset::ManifestsIn(set));
  for (const int64_t clip : manifest.done())
    for (const dataset::StoredFile& file : dataset::FilesOfLine(manifest.Line(clip))) {
      struct stat status = {};
      if (stat((set / file.path).c_str(), &status) == 0) inodes[file.path] = status.st_ino;
    }
  return inodes;
}

}  // namespace shimmer::app
