// A power cut, on paper: from what fail_calls.c has written down of a run (SHIMMER_FAIL_LOG), what a disk may
// hold if the power goes after any of its changes.
//
// What was synced is there. Of the rest, bytes are missing from some place on, or are zeros here and there;
// names that were made, moved or removed are so or not, each by chance or all up to some moment, but those of
// one file in their order. A rename is there when the folder that it moved to was synced; a file system may
// do better.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace shimmer::app {

class PowerCut {
 public:
  // log: the text of it; root: the folder that was SHIMMER_FAIL_ROOT, and empty before.
  PowerCut(const std::string& log, const std::filesystem::path& root);

  size_t changes() const { return changes_.size(); }
  std::vector<size_t> Syncs() const;  // changes that there are right before and right after each sync

  // Writes below `to`, which is made anew, what may be left if the power goes after so many changes.
  void Rebuild(size_t changes, uint32_t seed, const std::filesystem::path& to) const;

 private:
  enum class Kind { kNames, kWrite, kTruncate, kSync, kSyncAll };
  using Name = std::pair<int, std::string>;  // in which folder
  struct Change {
    Kind kind = Kind::kNames;
    int node = -1;                            // whose bytes, or who is synced or moved
    std::vector<std::pair<Name, int>> names;  // of kNames: what they mean from now on; -1: nothing
    uint64_t place = 0;                       // of a write; of a cut the size
    std::string bytes;
  };
  struct Node {
    bool is_folder = false;
    std::string bytes;
  };

  void Note(const std::string& what, const std::string& path, const std::string& more, std::string bytes);
  Name NameOf(const std::string& path) const;
  int NodeOf(const std::string& path) const;
  int NewNode(bool is_folder);

  std::vector<bool> Durable(size_t changes) const;
  std::set<size_t> Kept(size_t changes, std::mt19937& random) const;
  void ApplyBytes(const std::vector<size_t>& of_node, const std::vector<bool>& durable, std::mt19937& random,
                  Node& node) const;

  std::string root_;
  std::vector<Change> changes_;
  std::vector<bool> is_folder_ = {true};  // by node; node 0 is the root
  std::map<Name, int> names_;             // as the run left them
};

}  // namespace shimmer::app
