// Whether a data set holds what its config, its layout and its manifest say: every clip, every file, every
// bit and every pixel, and nothing else. It looks, and changes nothing.
//
// Work is cut into units (a clip, or a tar of them), which many threads may verify at once; the rest is
// quick. In memory is what is wrong, and a number a clip.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/layout.h"

namespace shimmer::dataset {

enum class ProblemKind {
  kMissing,      // a file
  kTruncated,    // shorter than it was
  kLonger,       // than it was
  kDamaged,      // as long as it was, and other bytes; or bytes that don't decode to the pixels they should
  kSwapped,      // holds what belongs to another file of the set
  kInTheWay,     // something else than a file: a link, a folder; or one that can't be read
  kMissingClip,  // neither done nor failed
  kManifest,     // a line that is damaged, or names other files than its clip must have
  kDescription,  // dataset.json does not agree with itself
  kDerived,      // a file of derived_files.h that is not there or says something else
  kSurplus,      // a file, link or empty folder that nobody knows
};

struct ClipRange {
  int64_t first, last;  // both included
};

struct Problem {
  ProblemKind kind;
  std::string name;  // a file's, as StoredFile::name() gives it; "clip 12"; "manifest.jsonl:3"
  std::string text;  // what is wrong with it, and what would be right
  std::optional<ClipRange> clips = {};  // that must be made again for it
  std::string sha256 = {};              // of a file whose bytes are not those of the manifest: what they are
};

// A data set, and what it should hold by its config.
struct Contents {
  const DatasetReader& set;
  Layout layout;
  int64_t clips;              // 0 .. clips - 1
  int64_t frames;             // that are kept of each
  std::set<FrameKind> truth;  // TruthKinds

  // How many files of a kind each clip must have.
  int64_t FilesOf(FrameKind kind, bool one_clean) const {
    const bool has = kind == FrameKind::kTurb || kind == FrameKind::kClean || truth.contains(kind);
    return has ? FilesOfKind(kind, frames, one_clean) : 0;
  }
};

struct UnitFindings {
  std::vector<Problem> problems;
  std::vector<int64_t> one_clean;  // clips whose clean frames are one file
};

// The clips of a unit that are done: their lines, and their files.
UnitFindings VerifyUnit(const Contents& contents, int64_t unit);

// Names the file whose bytes another one holds (kSwapped) where it is one of the set.
void NameSwapped(const DatasetReader& set, std::vector<Problem>& problems);

// Clips that are missing, as few ranges; lines of the manifest that a kill tore; derived files. Those follow
// from the lines, and are looked at where all clips are there and `lines`, problems found so far, has none of
// a line.
std::vector<Problem> VerifyManifest(const Contents& contents, const std::vector<Problem>& lines);

// Whatever lies in the folder and is not named, by its path. Links are not followed. one_clean: what
// VerifyUnit has found of all clips. Our hidden files at the top are known; clips on their way
// (kStagingName), which a killed run has left, are surplus.
std::vector<Problem> FindSurplus(const Contents& contents, const std::set<int64_t>& one_clean);

// Moves what lies at this path of the data set to .surplus/ under its path (.surplus.1/ where that is taken),
// and takes away folders that are empty then. Gives where it lies now, relative to the data set's folder.
std::string MoveToSurplus(const std::filesystem::path& folder, const std::string& path);
inline constexpr const char* kSurplusName = ".surplus";

}  // namespace shimmer::dataset
