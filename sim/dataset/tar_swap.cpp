#include "sim/dataset/tar_swap.h"

#include <fcntl.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"
#include "sim/dataset/manifest.h"
#include "sim/dataset/sha256.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBefore = ".before";

using FilesOfTars = std::map<std::string, std::vector<StoredFile>>;  // by the tars' file names

FilesOfTars NamedFiles(const fs::path& folder) {
  FilesOfTars files;
  const Manifest manifest(ManifestsIn(folder));
  manifest.ForEachLine([&](int64_t clip, const Json& line) {
    if (!manifest.done().contains(clip)) return;
    for (const StoredFile& file : FilesOfLine(line))
      files[fs::path(file.path).filename().string()].push_back(file);
  });
  return files;
}

bool Holds(const fs::path& tar, const std::vector<StoredFile>& files) {
  return fs::is_regular_file(tar) && std::ranges::all_of(files, [&](const StoredFile& file) {
           return Sha256Hex(ReadPart(tar, static_cast<uint64_t>(file.offset),
                                     static_cast<size_t>(file.bytes))) == file.sha256;
         });
}

std::vector<fs::path> KeptTars(const fs::path& staging) {
  return ExpandGlob(staging, std::string("*.tar") + kBefore);
}

}  // namespace

void KeepTar(const fs::path& tar, const fs::path& staging) {
  if (!fs::exists(tar)) return;
  const fs::path before = staging / (tar.filename().string() + kBefore);
  MakeFolders(staging);
  LinkOrCopy(tar, before);
  FileHandle(before, O_RDONLY).Sync();
  SyncFolder(staging);
}

void DropKeptTars(const fs::path& staging) {
  for (const fs::path& before : KeptTars(staging)) RemoveAll(before);
}

void SettleKeptTars(const fs::path& folder, const fs::path& staging) {
  const std::vector<fs::path> kept = KeptTars(staging);
  if (kept.empty()) return;
  const FilesOfTars named = NamedFiles(folder);
  for (const fs::path& before : kept) {
    const auto of_tar = named.find(before.stem().string());
    if (of_tar != named.end()) {
      const fs::path tar = folder / of_tar->second.front().path;
      if (!Holds(tar, of_tar->second)) {
        Rename(before, tar);
        SyncFolder(tar.parent_path());
      }
    }
    RemoveAll(before);
  }
}

}  // namespace shimmer::dataset
