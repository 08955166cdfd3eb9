// A small data set to write: descriptions, layouts, and clips whose files are short texts, and what lies in a
// folder.
#pragma once

#include <map>

#include "sim/dataset/dataset_writer.h"
#include "sim/dataset/sha256.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {

inline Json Description() {
  return Json::parse(R"({
    "config": {"seed": 7, "clips": 10, "tilt": {"strength_px": 5, "octaves": 8}, "size": [256, 256], "objects": []},
    "config_hash": "abc", "engine": 1, "version": "0.1.0",
    "sources": [{"path": "a.jpg", "sha256": "aa"}, {"path": "b.jpg", "sha256": "bb"}]})");
}

inline Layout Sequence() { return {}; }
inline Layout Pairs() {
  return {.kind = LayoutKind::kPairs, .name = "set", .test_fraction = 0.5, .frames_per_clip = 2};
}

// Two frames of each kind; the bytes say which. truth: with truth files.
inline std::vector<ClipFile> SmallClip(const Layout& layout, int64_t clip, bool truth = true) {
  std::vector<ClipFile> files;
  for (const FrameKind kind : {FrameKind::kTurb, FrameKind::kClean, FrameKind::kTruth}) {
    if (kind == FrameKind::kTruth && !truth) continue;
    for (int64_t frame = 0; frame < 2; ++frame) {
      const std::string path = layout.Path(kind, clip, frame), text = "bytes of " + path;
      files.push_back({path, {text.begin(), text.end()}, "hash of " + path});
    }
  }
  return files;
}

// The whole way of a clip at once, durable when it returns.
inline void CommitNow(DatasetWriter& writer, int64_t clip, const std::vector<ClipFile>& files,
                      Json line = Json::object()) {
  StagedClip staged = writer.Stage(clip);
  for (const ClipFile& file : files) staged.Add(file);
  writer.Commit(std::move(staged), std::move(line));
  writer.Flush();
}
inline void FailNow(DatasetWriter& writer, int64_t clip, Json line) {
  writer.Fail(clip, std::move(line));
  writer.Flush();
}

// Every file below a folder by its path, with its content; what starts with a dot is left out.
inline std::map<std::string, std::string> Tree(const std::filesystem::path& folder) {
  std::map<std::string, std::string> tree;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_regular_file() || name[0] == '.') continue;
    const std::vector<uint8_t> bytes = ReadFile(entry.path());
    tree[name] = std::string(bytes.begin(), bytes.end());
  }
  return tree;
}

}  // namespace shimmer::dataset
