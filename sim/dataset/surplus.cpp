#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/derived_files.h"
#include "sim/dataset/files.h"
#include "sim/dataset/folder_lock.h"
#include "sim/dataset/hash_memory.h"
#include "sim/dataset/verify.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// At the top of a data set's folder, and at no other place. (Of locks and of what has
// been moved there may be more, with numbers after their names.)
bool IsOurs(const std::string& name) {
  constexpr std::array<const char*, 3> kExact = {kDescriptionName, kManifestName, "report.html"};
  constexpr std::array<const char*, 4> kHidden = {kLockName, kHashMemoryName, kOriginName, kSurplusName};
  return std::ranges::count(kExact, name) > 0 ||
         (name.starts_with("manifest.") && name.ends_with(".jsonl") &&
          name.find("-of-") != std::string::npos) ||
         std::ranges::any_of(kHidden, [&](const char* hidden) { return name.starts_with(hidden); });
}

class Walk {
 public:
  Walk(const Contents& contents, const std::set<int64_t>& one_clean)
      : contents_(contents), layout_(contents.layout), one_clean_(one_clean) {}

  std::vector<Problem> Run() {
    Visit("");
    AddEmptyFolders();
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& text) {
    problems_.push_back({ProblemKind::kSurplus, path, text});
  }

  // Whether a file lies there or below. path: relative, "" of the data set itself.
  bool Visit(const std::string& path) {
    std::error_code error;
    bool has_files = false;
    for (auto entry = fs::directory_iterator(contents_.set.folder() / path, error);
         !error && entry != fs::directory_iterator(); entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      has_files =
          (path.empty() ? VisitTop(name, *entry) : VisitEntry(path + "/" + name, *entry)) || has_files;
    }
    if (error) {
      problems_.push_back({ProblemKind::kInTheWay, path, "can't be looked into: " + error.message()});
      return true;
    }
    if (!has_files && !path.empty()) empty_.insert(path);
    return has_files;
  }

  bool VisitTop(const std::string& name, const fs::directory_entry& entry) {
    if (name.starts_with(kStagingName))
      return Add(name, "surplus: what a run that was killed has left"), true;
    const bool link = entry.is_symlink();
    if (IsOurs(name) && !link) return true;
    if (name == kDescriptionName || (name.starts_with("manifest.") && IsOurs(name))) {
      problems_.push_back({ProblemKind::kManifest, name, "a link, must be a file"});
      return true;
    }
    return VisitEntry(name, entry);
  }

  bool VisitEntry(const std::string& path, const fs::directory_entry& entry) {
    const Owner owner = OwnerOf(path);
    if (owner == Owner::kDone || (owner == Owner::kMissing && !entry.is_symlink() && entry.is_regular_file()))
      return true;
    if (!entry.is_symlink() && entry.is_directory()) return Visit(path);
    Add(path, entry.is_symlink()        ? "surplus: a link"
              : entry.is_regular_file() ? "surplus: no file of the set"
                                        : "surplus: a device or pipe");
    return true;
  }

  bool IsMissing(int64_t clip) const {
    return clip < contents_.clips && !contents_.set.clips().contains(clip) &&
           !contents_.set.failed().contains(clip);
  }

  // Whose place it is: what is wrong with that of a clip that is done is said with its files (VerifyUnit).
  // What a missing clip may have left is no surplus either: it is made again over it.
  enum class Owner { kNobody, kMissing, kDone };
  Owner OwnerOf(int64_t clip) const {
    return contents_.set.clips().contains(clip) ? Owner::kDone
           : IsMissing(clip)                    ? Owner::kMissing
                                                : Owner::kNobody;
  }
  Owner OwnerOf(const std::string& path) const {
    if (IsDerivedPath(path, layout_)) return Owner::kDone;
    if (const auto unit = layout_.UnitOfTar(path)) {
      const int64_t begin = *unit * layout_.clips_per_tar;
      Owner owner = Owner::kNobody;
      for (int64_t clip = begin; clip < begin + layout_.clips_per_tar; ++clip)
        owner = std::max(owner, OwnerOf(clip));
      return owner;
    }
    const auto place = layout_.IsTars() ? std::nullopt : layout_.PlaceOf(path);
    const bool known =
        place && place->frame < contents_.FilesOf(place->kind, one_clean_.contains(place->clip));
    return known ? OwnerOf(place->clip) : Owner::kNobody;
  }

  // A folder without a file is surplus, unless files are missing that belong there.
  void AddEmptyFolders() {
    if (empty_.empty()) return;
    const auto keep = [&](const std::string& path) {
      for (fs::path folder = fs::path(path).parent_path(); !folder.empty(); folder = folder.parent_path())
        empty_.erase(folder.string());
    };
    for (const int64_t clip : contents_.set.clips())
      for (const FrameKind kind : kFrameKinds)
        if (!layout_.IsTars() && contents_.FilesOf(kind, false) > 0) keep(layout_.Path(kind, clip, 0));
    if (layout_.IsTars()) keep(layout_.TarPath(0));
    for (const std::string& path : empty_)
      if (!empty_.contains(fs::path(path).parent_path().string())) Add(path, "surplus: an empty folder");
  }

  const Contents& contents_;
  const Layout& layout_;
  const std::set<int64_t>& one_clean_;
  std::vector<Problem> problems_;
  std::set<std::string> empty_;
};

// Something may be put there without following a link or overwriting anything.
bool IsFree(const fs::path& folder, const fs::path& path) {
  if (fs::exists(fs::symlink_status(folder / path))) return false;
  for (fs::path above = path.parent_path(); !above.empty(); above = above.parent_path()) {
    const fs::file_status status = fs::symlink_status(folder / above);
    if (fs::exists(status) && !fs::is_directory(status)) return false;
  }
  return true;
}

}  // namespace

std::vector<Problem> FindSurplus(const Contents& contents, const std::set<int64_t>& one_clean) {
  return Walk(contents, one_clean).Run();
}

std::string MoveToSurplus(const fs::path& folder, const std::string& path) {
  fs::path to = fs::path(kSurplusName) / path;
  for (int i = 1; !IsFree(folder, to); ++i) to = fs::path(kSurplusName + ("." + std::to_string(i))) / path;
  MakeFolders((folder / to).parent_path());
  Rename(folder / path, folder / to);
  SyncFolder((folder / to).parent_path());
  fs::path above = fs::path(path).parent_path();
  SyncFolder(folder / above);
  std::error_code not_empty;
  for (; !above.empty() && fs::remove(folder / above, not_empty) && !not_empty; above = above.parent_path()) {
  }
  return to.string();
}

}  // namespace shimmer::dataset
