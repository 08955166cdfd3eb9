#include "sim/dataset/glob.h"

#include <fnmatch.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <system_error>

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// The folders from the start of a walk to here, so that a link back up is walked no second time.
class Trail {
 public:
  bool Enter(const fs::path& folder) {
    const fs::path real = fs::canonical(folder);
    if (std::ranges::count(folders_, real) > 0) return false;
    folders_.push_back(real);
    return true;
  }
  void Leave() { folders_.pop_back(); }

 private:
  std::vector<fs::path> folders_;
};

using Names = std::span<const fs::path>;

void Match(const fs::path& here, Names names, std::vector<fs::path>& found);

// names after a "**": here, and in every folder below.
void MatchAnyDepth(const fs::path& here, Names names, Trail& trail, std::vector<fs::path>& found) {
  if (!fs::is_directory(here) || !trail.Enter(here)) return;
  Match(here, names, found);
  for (const fs::path& entry : VisibleEntries(here)) MatchAnyDepth(entry, names, trail, found);
  trail.Leave();
}

void Match(const fs::path& here, Names names, std::vector<fs::path>& found) {
  if (names.empty()) {
    found.push_back(here);
    return;
  }
  const std::string name = names[0].string();
  const Names rest = names.subspan(1);
  if (name == "**") {
    static const std::vector<fs::path> anything = {"*"};
    Trail trail;
    MatchAnyDepth(here, rest.empty() ? Names(anything) : rest, trail, found);
  } else if (!HasWildcards(name)) {
    if (fs::exists(here / name)) Match(here / name, rest, found);
  } else if (fs::is_directory(here)) {
    for (const auto& entry : fs::directory_iterator(here))
      if (fnmatch(name.c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0)
        Match(entry.path(), rest, found);
  }
}

void AddFilesBelow(const fs::path& folder, Trail& trail, std::vector<fs::path>& found) {
  if (!trail.Enter(folder)) return;
  for (const fs::path& entry : VisibleEntries(folder)) {
    if (fs::is_directory(entry))
      AddFilesBelow(entry, trail, found);
    else
      found.push_back(entry);
  }
  trail.Leave();
}

}  // namespace

bool HasWildcards(const std::string& pattern) { return pattern.find_first_of("*?[") != std::string::npos; }

std::vector<fs::path> ExpandGlob(const fs::path& base, const std::string& pattern) {
  const fs::path whole(pattern);
  const fs::path relative = whole.relative_path();
  const std::vector<fs::path> names(relative.begin(), relative.end());
  const fs::path start = whole.is_absolute() ? whole.root_path() : base.empty() ? fs::path(".") : base;
  std::vector<fs::path> found;
  Match(start, names, found);
  return found;
}

std::vector<fs::path> VisibleEntries(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string()[0] != '.') entries.push_back(entry.path());
  std::ranges::sort(entries);
  return entries;
}

std::vector<fs::path> FilesBelow(const fs::path& folder) {
  std::vector<fs::path> found;
  Trail trail;
  AddFilesBelow(folder, trail, found);
  return found;
}

}  // namespace shimmer::dataset
