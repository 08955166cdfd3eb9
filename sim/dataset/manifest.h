// manifest.jsonl: a line a clip, each a JSON object with at least "clip" (its number) and "status" ("done" or
// "failed"). The last line of a clip counts. A last line that a kill tore (no newline, or no JSON) counts as
// not written; a damaged line anywhere else is an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "sim/dataset/files.h"

namespace shimmer::dataset {

using Json = nlohmann::json;

// What a manifest says. Lines stay on disk (10 kB each, 100,000 of them) until they are asked for.
class Manifest {
 public:
  // An absent file is an empty manifest. Throws std::runtime_error "PATH:LINE: what is wrong".
  explicit Manifest(std::filesystem::path path);

  const std::set<int64_t>& done() const { return done_; }
  const std::set<int64_t>& failed() const { return failed_; }
  uint64_t whole_bytes() const { return whole_bytes_; }  // of the file without a torn last line

  // The line that counts. Throws std::runtime_error if the clip has none or the file has changed.
  Json Line(int64_t clip) const;

 private:
  void Note(const std::string& line, uint64_t offset);

  std::filesystem::path path_;
  std::map<int64_t, uint64_t> offsets_;  // of each clip's last line
  std::set<int64_t> done_, failed_;
  uint64_t whole_bytes_ = 0;
};

// Adds lines. For one thread at a time.
class ManifestWriter {
 public:
  // Cuts the file to whole_bytes first, which removes a torn last line.
  ManifestWriter(const std::filesystem::path& path, uint64_t whole_bytes);

  // The line is on disk when this returns; if it throws, it is not there at all.
  void Append(const Json& line);

 private:
  FileHandle file_;
  uint64_t whole_bytes_;
};

}  // namespace shimmer::dataset
