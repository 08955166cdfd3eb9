// A part of a data set that one process makes: of the units (a clip, or a tar of clips) every count-th one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace shimmer::dataset {

struct Shard {
  int64_t index = 0;  // 0 .. count - 1
  int64_t count = 1;  // 1: the whole set

  void Validate() const;  // throws std::invalid_argument

  bool whole() const { return count == 1; }
  bool Has(int64_t unit) const { return unit % count == index; }

  // What its own files are told apart by: "" of the whole set, else ".003-of-008".
  std::string Suffix() const;

  friend bool operator==(const Shard&, const Shard&) = default;
};

// Whose manifest has such a name: of manifest.003-of-008.jsonl, {3, 8}; nothing of any other.
std::optional<Shard> ShardOfManifest(const std::string& name);

}  // namespace shimmer::dataset
