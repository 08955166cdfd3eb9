#include "tests/soak/power_cut.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "sim/dataset/files.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;

uint32_t Below(std::mt19937& random, uint64_t end) { return static_cast<uint32_t>(random() % end); }

// Zeros in the place of any page of a write.
void LosePages(std::string& bytes, size_t start, size_t size, std::mt19937& random) {
  constexpr size_t kPage_bytes = 4096;
  for (size_t at = start; at < start + size;) {
    const size_t end = std::min(start + size, (at / kPage_bytes + 1) * kPage_bytes);
    if (Below(random, 2) == 0) bytes.replace(at, end - at, end - at, '\0');
    at = end;
  }
}

}  // namespace

PowerCut::PowerCut(const std::string& text, const fs::path& root) : root_(root) {
  for (size_t at = 0; at < text.size();) {
    const size_t path = text.find('\t', at) + 1, more = text.find('\t', path) + 1,
                 end = text.find('\n', more);
    const std::string what = text.substr(at, path - at - 1), rest = text.substr(more, end - more);
    const size_t bytes = what == "write" ? std::stoull(rest.substr(rest.find(' ') + 1)) : 0;
    Note(what, text.substr(path, more - path - 1), rest, text.substr(end + 1, bytes));
    at = end + 1 + bytes;
  }
}

void PowerCut::Note(const std::string& what, const std::string& path, const std::string& more,
                    std::string bytes) {
  Change change;
  if (what == "create" || what == "mkdir") {
    change.names = {{NameOf(path), change.node = NewNode(what == "mkdir")}};
  } else if (what == "rename") {
    change.node = NodeOf(path);
    change.names = {{NameOf(path), -1}, {NameOf(more), change.node}};
    if (NodeOf(more) == change.node) return;  // two names of one file: nothing happens
  } else if (what == "link") {
    change.node = NodeOf(path);
    change.names = {{NameOf(more), change.node}};
  } else if (what == "unlink") {
    change.node = NodeOf(path);
    change.names = {{NameOf(path), -1}};
  } else {
    if (path.ends_with(" (deleted)")) return;
    change.node = NodeOf(path);
    change.kind = what == "write"      ? Kind::kWrite
                  : what == "truncate" ? Kind::kTruncate
                  : what == "sync"     ? Kind::kSync
                                       : Kind::kSyncAll;
    if (change.kind == Kind::kWrite || change.kind == Kind::kTruncate) change.place = std::stoull(more);
    change.bytes = std::move(bytes);
  }
  for (const auto& [name, node] : change.names)
    if (node < 0)
      names_.erase(name);
    else
      names_[name] = node;
  changes_.push_back(std::move(change));
}

int PowerCut::NewNode(bool is_folder) {
  is_folder_.push_back(is_folder);
  return static_cast<int>(is_folder_.size()) - 1;
}

PowerCut::Name PowerCut::NameOf(const std::string& path) const {
  return {NodeOf(fs::path(path).parent_path()), fs::path(path).filename()};
}

int PowerCut::NodeOf(const std::string& path) const {
  int node = 0;
  for (const fs::path& name : fs::path(path).lexically_relative(root_)) {
    if (name == ".") continue;
    const auto found = names_.find({node, name});
    if (found == names_.end()) return -1;
    node = found->second;
  }
  return node;
}

std::vector<size_t> PowerCut::Syncs() const {
  std::vector<size_t> moments;
  for (size_t i = 0; i < changes_.size(); ++i)
    if (changes_[i].kind == Kind::kSync || changes_[i].kind == Kind::kSyncAll)
      moments.insert(moments.end(), {i, i + 1});
  return moments;
}

// What is on the disk for sure: synced, or an earlier change of the same name or file than one that is.
std::vector<bool> PowerCut::Durable(size_t changes) const {
  std::vector<bool> durable(changes);
  bool all = false;
  std::set<int> synced, bytes_needed, nodes_needed;
  std::set<Name> names_needed;
  for (size_t i = changes; i-- > 0;) {
    const Change& change = changes_[i];
    if (change.kind == Kind::kSyncAll) all = true;
    if (change.kind == Kind::kSync) synced.insert(change.node);
    if (change.kind == Kind::kNames) {
      durable[i] =
          all || synced.contains(change.names.back().first.first) || nodes_needed.contains(change.node) ||
          std::ranges::any_of(change.names, [&](const auto& n) { return names_needed.contains(n.first); });
      if (!durable[i]) continue;
      nodes_needed.insert(change.node);
      for (const auto& [name, node] : change.names) names_needed.insert(name);
    } else {
      durable[i] = all || synced.contains(change.node);
    }
  }
  return durable;
}

// The changes of names that are on the disk, by chance where nothing says so.
std::set<size_t> PowerCut::Kept(size_t changes, std::mt19937& random) const {
  const std::vector<bool> durable = Durable(changes);
  // None of the others; all up to some moment, as a journal has it; each as it comes.
  const uint32_t way = Below(random, 3);
  const size_t journal_end = Below(random, changes + 1);
  std::set<size_t> kept;
  std::set<int> nodes_lost;
  std::set<Name> names_lost;
  for (size_t i = 0; i < changes; ++i) {
    const Change& change = changes_[i];
    if (change.kind != Kind::kNames) continue;
    const bool lucky = way == 1 ? i < journal_end : way == 2 && Below(random, 2) == 0;
    const bool lost =
        nodes_lost.contains(change.node) ||
        std::ranges::any_of(change.names, [&](const auto& n) { return names_lost.contains(n.first); });
    if (durable[i] || (lucky && !lost)) {
      kept.insert(i);
      continue;
    }
    nodes_lost.insert(change.node);
    for (const auto& [name, node] : change.names) names_lost.insert(name);
  }
  return kept;
}

// of_node: the writes and cuts of one file, in order. Of those that are not durable none is there, or some
// with the last one torn, or all of them: with zeros in the place of any page, or as they were.
void PowerCut::ApplyBytes(const std::vector<size_t>& of_node, const std::vector<bool>& durable,
                          std::mt19937& random, Node& node) const {
  enum Way { kNone, kTorn, kPages, kAll };
  const auto way = static_cast<Way>(Below(random, 4));
  const auto sure = static_cast<size_t>(std::ranges::find_if(of_node, [&](size_t i) { return !durable[i]; }) -
                                        of_node.begin());
  const size_t loose = of_node.size() - sure;
  const size_t there = sure + (way == kNone ? 0 : way == kTorn ? Below(random, loose + 1) : loose);
  for (size_t i = 0; i < there; ++i) {
    const Change& change = changes_[of_node[i]];
    if (change.kind == Kind::kTruncate) {
      node.bytes.resize(change.place);
      continue;
    }
    std::string bytes = change.bytes;
    if (i >= sure && way == kTorn && i + 1 == there) bytes.resize(Below(random, bytes.size() + 1));
    if (node.bytes.size() < change.place + bytes.size()) node.bytes.resize(change.place + bytes.size());
    node.bytes.replace(change.place, bytes.size(), bytes);
    if (i >= sure && way == kPages) LosePages(node.bytes, change.place, bytes.size(), random);
  }
}

void PowerCut::Rebuild(size_t changes, uint32_t seed, const fs::path& to) const {
  std::mt19937 random(seed);
  std::map<Name, int> names;
  for (const size_t i : Kept(changes, random))
    for (const auto& [name, node] : changes_[i].names)
      if (node < 0)
        names.erase(name);
      else
        names[name] = node;
  const std::vector<bool> durable = Durable(changes);
  std::map<int, std::vector<size_t>> bytes_of_node;
  for (size_t i = 0; i < changes; ++i)
    if (changes_[i].kind == Kind::kWrite || changes_[i].kind == Kind::kTruncate)
      bytes_of_node[changes_[i].node].push_back(i);
  std::map<int, Node> nodes;
  for (const auto& [number, of_node] : bytes_of_node) ApplyBytes(of_node, durable, random, nodes[number]);

  fs::remove_all(to);
  const std::function<void(int, const fs::path&)> put = [&](int folder, const fs::path& path) {
    fs::create_directory(path);
    for (auto name = names.lower_bound({folder, ""}); name != names.end() && name->first.first == folder;
         ++name) {
      const fs::path below = path / name->first.second;
      if (is_folder_[static_cast<size_t>(name->second)])
        put(name->second, below);
      else
        dataset::WriteUnsynced(below, dataset::AsBytes(nodes[name->second].bytes));
    }
  };
  put(0, to);
}

}  // namespace shimmer::app
