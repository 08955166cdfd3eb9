// Where the files of a clip lie in a data set's folder.
//
//   sequence   clips/000123/turb/0000.png    clips/000123/clean/0000.png    clips/000123/truth/0000.exr
//   pairs      NAME/train/turb/000123.png    NAME/train/noturb/000123.png   NAME/train/truth/000123.exr
//              NAME/test/...                 (numbered clip * frames_per_clip + frame)
//
// Training code reads pairs by listing turb and noturb and taking them in sorted order, so nothing else may
// ever lie in those folders, and every number in them must have the same length.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {

enum class LayoutKind { kSequence, kPairs };
enum class FrameKind { kTurb, kClean, kTruth };

struct Layout {
  LayoutKind kind = LayoutKind::kSequence;
  FileFormat format = FileFormat::kPng;  // of turb and clean; truth is EXR

  // Of pairs only:
  std::string name = "shimmer";
  double test_fraction = 0.02;
  int64_t frames_per_clip = 1;
  int digits = 6;  // of the numbers, the same for the whole data set (PairDigits)

  // Throws std::invalid_argument: a name that is no plain folder name, a number out of its range.
  void Validate() const;

  // Relative to the data set's folder, parts joined by "/". frame: 0 .. frames - 1, in pairs 0 ..
  // frames_per_clip - 1.
  std::string Path(FrameKind kind, int64_t clip, int64_t frame) const;

  // The one folder that holds a clip and nothing else, or "" where there is none (pairs).
  std::string ClipFolder(int64_t clip) const;
};

// A folder's name that no path, option or file of a data set can be taken for: 1 to 100 bytes, no '/', '\\'
// or control characters, no '.' or '-' at its start, not "clips".
bool IsPlainFolderName(const std::string& name);

// Exactly a fraction of all clips, whatever their number: clip i is one iff floor((i + 1) f) > floor(i f).
bool IsTestClip(int64_t clip, double test_fraction);

// 6, or 9 if clips * frames_per_clip is over a million. Ask with the most clips that the data set may ever
// have.
int PairDigits(int64_t clips, int64_t frames_per_clip);

}  // namespace shimmer::dataset
