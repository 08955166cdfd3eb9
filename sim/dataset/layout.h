// Where the files of a clip lie in a data set's folder.
//
//   sequence    clips/000123/turb/0000.png    clips/000123/clean/0000.png    clips/000123/truth/0000.exr
//   pairs       NAME/train/turb/000123.png    NAME/train/noturb/000123.png   NAME/train/truth/000123.exr
//   restormer   NAME/train/lq/000123.png      NAME/train/gt/000123.png       NAME/train/truth/000123.exr
//   basicsr     lq/123/00000000.png           gt/123/00000000.png            truth/123/00000000.exr
//   webdataset  shards/000012.tar/000123.turb.0000.png, ...: a path in a tar as if the tar were a folder
//
// What is known of a clip lies beside its frames, in folders of the same kind: truth/ (EXR: dx, dy, sigma),
// mask/ (PNG), flow/ (EXR: from a frame to the next, so none of the last), and one shake.json a clip: in
// sequence clips/000123/shake.json, in a tar 000123.shake.json, elsewhere shake/, as if it were frame 0.
//
// Of pairs and restormer a clip lies in NAME/train or NAME/test, numbered clip * frames_per_clip + frame.
// Training code reads them by listing two folders and taking them in sorted order, so nothing else may ever
// lie in those, and every number in them must have the same length: they are flat, however large the set.
// sequence and basicsr have at most a thousand clips a folder: clips 1000 to 1999 lie in clips.001/ and in
// part001/gt/, part001/lq/, and so on; of basicsr each part is numbered from 000 and is a set of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {

enum class LayoutKind { kSequence, kPairs, kRestormer, kBasicsr, kWebdataset };
enum class FrameKind { kTurb, kClean, kTruth, kMask, kFlow, kShake };
inline constexpr std::array<FrameKind, 6> kFrameKinds = {FrameKind::kTurb,  FrameKind::kClean,
                                                         FrameKind::kTruth, FrameKind::kMask,
                                                         FrameKind::kFlow,  FrameKind::kShake};

// The kinds that stand beside turb and clean where output.truth says so: tilt and sigma share one file.
std::set<FrameKind> TruthKinds(std::span<const std::string> truth);

// How many files of a kind a clip of so many frames has, if it has any.
int64_t FilesOfKind(FrameKind kind, int64_t frames, bool one_clean);

struct Layout {
  LayoutKind kind = LayoutKind::kSequence;
  FileFormat format = FileFormat::kPng;  // of turb and clean

  // Of pairs and restormer only:
  std::string name = "shimmer";
  double test_fraction = 0.02;
  int64_t frames_per_clip = 1;
  int digits = 6;  // of the numbers, the same for the whole data set (PairDigits)

  // Of webdataset only:
  int64_t clips_per_tar = 1;

  // Throws std::invalid_argument: a name that is no plain folder name, a number out of its range.
  void Validate() const;

  bool IsPairs() const { return kind == LayoutKind::kPairs || kind == LayoutKind::kRestormer; }
  bool IsTars() const { return kind == LayoutKind::kWebdataset; }
  // Clean frames that are all the same stand once.
  bool OneCleanFile() const { return kind == LayoutKind::kSequence || kind == LayoutKind::kWebdataset; }

  // Relative to the data set's folder, parts joined by "/". frame: 0 .. frames - 1, in pairs and restormer 0
  // .. frames_per_clip - 1.
  std::string Path(FrameKind kind, int64_t clip, int64_t frame) const;

  // The other way: so that Path gives this path. Nothing for any other path; a frame may be one that no clip
  // has.
  struct Place {
    FrameKind kind;
    int64_t clip, frame;
  };
  std::optional<Place> PlaceOf(const std::string& path) const;

  // The folders that hold files of this clip and nothing else; none where there are no such folders.
  std::vector<std::string> ClipFolders(int64_t clip) const;

  // Clips are written in units, whole or not at all: one by one, or a tar of them.
  int64_t ClipsPerUnit() const { return IsTars() ? clips_per_tar : 1; }
  int64_t UnitOf(int64_t clip) const { return clip / ClipsPerUnit(); }
  std::string TarPath(int64_t unit) const;
  std::optional<int64_t> UnitOfTar(const std::string& path) const;  // so that TarPath gives this path
};

inline constexpr int64_t kClipsPerFolder = 1000;  // of sequence and basicsr

// Which kind of frame a file is, by the folder that it lies in, or by its name in a tar.
std::optional<FrameKind> KindOfPath(const std::string& path);

// A folder's name that no path, option or file of a data set can be taken for: 1 to 100 bytes, no '/', '\\'
// or control characters, no '.' or '-' at its start, not "clips".
bool IsPlainFolderName(const std::string& name);

// Exactly a fraction of all clips, whatever their number: clip i is one iff floor((i + 1) f) > floor(i f).
bool IsTestClip(int64_t clip, double test_fraction);

// 6, or 9 if clips * frames_per_clip is over a million. Ask with the most clips that the data set may ever
// have.
int PairDigits(int64_t clips, int64_t frames_per_clip);

}  // namespace shimmer::dataset
