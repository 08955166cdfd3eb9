// manifest.jsonl: a line a clip, each a JSON object with at least "clip" (its number) and "status" ("done" or
// "failed"). The last line of a clip counts. A last line that a kill tore (no newline, or no JSON) counts as
// not written, and so does a line with a zero byte and what follows it: a power cut while lines were being
// written leaves such. A damaged line anywhere else is an error.
//
// Shards write manifests of their own, manifest.003-of-008.jsonl, which count together with manifest.jsonl: a
// clip that is done in one of them is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <vector>

#include "sim/dataset/files.h"

namespace shimmer::dataset {

using Json = nlohmann::json;

// One of a clip's files, as its line names it.
struct StoredFile {
  std::string path;    // relative to the data set's folder; of a file in a tar, the tar's
  std::string member;  // its name in the tar; empty where it is a file of its own
  int64_t offset = 0;  // of its bytes in the tar
  int64_t bytes = -1;  // -1: not known (sets of an older version)
  std::string sha256;
  std::string pixels;  // pixel_hash.h; empty for what is no picture

  // As Layout::Path gives it: a tar counts as a folder.
  std::string name() const { return member.empty() ? path : path + "/" + member; }
  friend bool operator==(const StoredFile&, const StoredFile&) = default;
};

Json ToJson(const StoredFile& file);

// Of a line's "files". Throws std::runtime_error where one of them is not as it must be.
std::vector<StoredFile> FilesOfLine(const Json& line);

// manifest.jsonl and those of the shards that there are, in a data set's folder: manifest.jsonl first, the
// others sorted.
std::vector<std::filesystem::path> ManifestsIn(const std::filesystem::path& folder);

// What the manifests of a data set say. Lines stay on disk (6 kB each, 100,000 of them) until they are asked
// for.
class Manifest {
 public:
  // What is not there is empty. Throws std::runtime_error "PATH:LINE: what is wrong"; with damaged, such
  // lines are handed to it instead and do not count.
  using Damaged = std::function<void(const std::string& what)>;
  explicit Manifest(std::vector<std::filesystem::path> paths, const Damaged& damaged = {});
  explicit Manifest(const std::filesystem::path& path) : Manifest(std::vector{path}) {}

  const std::set<int64_t>& done() const { return done_; }
  const std::set<int64_t>& failed() const { return failed_; }

  const std::vector<std::filesystem::path>& paths() const { return paths_; }

  // Of one of the files: without a torn last line.
  uint64_t whole_bytes(const std::filesystem::path& path) const;

  // The line that counts. Throws std::runtime_error if the clip has none or the file has changed.
  Json Line(int64_t clip) const;

  // Every line that counts, by the clips' numbers: a quick walk through 100,000 of them, each read once.
  // Throws as Line.
  void ForEachLine(const std::function<void(int64_t clip, const Json& line)>& visit) const;

 private:
  struct Place {
    uint32_t file;
    uint64_t offset;
  };
  void Read(uint32_t file, const Damaged& damaged);
  void Note(const std::string& line, Place place);
  Json LineAt(std::ifstream& file, int64_t clip, Place place) const;

  std::vector<std::filesystem::path> paths_;
  std::vector<uint64_t> whole_bytes_;
  std::map<int64_t, Place> places_;  // of the line that counts
  std::set<int64_t> done_, failed_;
};

// Adds lines. For one thread at a time.
class ManifestWriter {
 public:
  // Cuts the file to whole_bytes first, which removes a torn last line.
  ManifestWriter(const std::filesystem::path& path, uint64_t whole_bytes);

  // The lines are on disk when this returns; if it throws, none of them is there.
  void Append(std::span<const Json> lines);

 private:
  FileHandle file_;
  uint64_t whole_bytes_;
};

}  // namespace shimmer::dataset
