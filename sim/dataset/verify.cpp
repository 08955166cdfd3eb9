#include "sim/dataset/verify.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "sim/dataset/derived_files.h"
#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// The gaps between known clips, as ranges.
std::vector<ClipRange> MissingClips(const Contents& contents) {
  std::vector<ClipRange> missing;
  int64_t next = 0;
  const auto know = [&](int64_t clip) {
    if (clip > next) missing.push_back({next, clip - 1});
    next = clip + 1;
  };
  const std::set<int64_t>&done = contents.set.clips(), &failed = contents.set.failed();
  for (auto a = done.begin(), b = failed.begin(); a != done.end() || b != failed.end();) {
    const bool take_done = b == failed.end() || (a != done.end() && *a < *b);
    const int64_t clip = take_done ? *a++ : *b++;
    if (clip >= contents.clips) break;
    know(clip);
  }
  know(contents.clips);
  return missing;
}

void VerifyDerived(const Contents& contents, std::vector<Problem>& problems) {
  for (const auto& [path, text] : DerivedFiles(contents.set, contents.layout)) {
    const fs::path place = contents.set.folder() / path;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(place, error);
    if (status.type() == fs::file_type::not_found || error == std::errc::not_a_directory) {
      problems.push_back({ProblemKind::kDerived, path, "missing"});
    } else if (status.type() != fs::file_type::regular) {
      problems.push_back({ProblemKind::kInTheWay, path, "a link, folder or device, must be a file"});
    } else {
      try {
        const bool same_size = fs::file_size(place) == text.size();
        if (!same_size || !std::ranges::equal(ReadFile(place), AsBytes(text)))
          problems.push_back({ProblemKind::kDerived, path, "damaged: says something else than the manifest"});
      } catch (const std::exception& cant_read) {
        problems.push_back({ProblemKind::kInTheWay, path, cant_read.what()});
      }
    }
  }
}

}  // namespace

std::vector<Problem> VerifyManifest(const Contents& contents, const std::vector<Problem>& lines) {
  std::vector<Problem> problems;
  const Manifest& manifest = contents.set.manifest();
  for (const fs::path& path : manifest.paths())
    if (fs::exists(path) && fs::file_size(path) != manifest.whole_bytes(path))
      problems.push_back({ProblemKind::kManifest, path.filename().string(), "its last line is torn"});
  for (const ClipRange& range : MissingClips(contents)) {
    const std::string name = range.first == range.last ? "clip " + std::to_string(range.first)
                                                       : "clips " + std::to_string(range.first) + " to " +
                                                             std::to_string(range.last);
    problems.push_back({ProblemKind::kMissingClip, name, "missing: neither done nor failed", range});
  }
  const auto of_clip = [](const Problem& problem) {
    return problem.kind == ProblemKind::kMissingClip || problem.kind == ProblemKind::kManifest;
  };
  if (std::ranges::none_of(lines, of_clip) && std::ranges::none_of(problems, of_clip))
    VerifyDerived(contents, problems);
  return problems;
}

void NameSwapped(const DatasetReader& set, std::vector<Problem>& problems) {
  std::map<std::string, std::string> owners;  // of bytes that lie elsewhere, by their hash
  for (const Problem& problem : problems)
    if (!problem.sha256.empty()) owners.emplace(problem.sha256, "");
  if (owners.empty()) return;
  set.manifest().ForEachLine([&](int64_t clip, const Json& line) {
    if (!set.clips().contains(clip)) return;
    try {
      for (const StoredFile& file : FilesOfLine(line))
        if (const auto owner = owners.find(file.sha256); owner != owners.end() && owner->second.empty())
          owner->second = file.name();
    } catch (const std::runtime_error&) {
      // VerifyUnit has said so.
    }
  });
  for (Problem& problem : problems) {
    const auto owner = owners.find(problem.sha256);
    if (owner == owners.end() || owner->second.empty()) continue;
    problem.kind = ProblemKind::kSwapped;
    problem.text = "swapped: holds what belongs to " + owner->second;
  }
}

}  // namespace shimmer::dataset
