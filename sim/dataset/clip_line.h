// What a clip's line of the manifest says, held against what it must say.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/dataset/manifest.h"
#include "sim/dataset/verify.h"

namespace shimmer::dataset {

struct ClipLine {
  int64_t clip = 0;
  std::vector<StoredFile> files;
  std::vector<int64_t> shape;  // width, height, channels
  bool one_clean = false;      // its clean frames are one file
};

// Of a clip that is done. Throws std::runtime_error where its line does not name each of its files, and them
// alone: the text goes on after "its line of the manifest".
ClipLine ReadClipLine(const Contents& contents, int64_t clip);

}  // namespace shimmer::dataset
