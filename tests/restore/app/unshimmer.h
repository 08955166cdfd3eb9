// The program `unshimmer` as people call it.
#pragma once

#include "restore/app/frame_source.h"
#include "tests/app/program.h"

namespace shimmer::restore::app {

using dataset::TempFolder;
using shimmer::app::ExpectDone;
using shimmer::app::ExpectOneLine;
using shimmer::app::Json;
using shimmer::app::Ran;
using shimmer::app::ReadText;
using shimmer::app::Words;

inline Ran Unshimmer(const TempFolder& folder, const Words& words) {
  return shimmer::app::Running(folder.path(), words, false, UNSHIMMER_PROGRAM).Wait();
}

// unshimmer restore VIDEO --out OUT --quiet --no-sharpen MORE: what a network would add has tests of its own
// (sharpen_test.cpp).
inline Ran Restored(const TempFolder& folder, const std::string& video, const std::string& out,
                    const Words& more = {}) {
  Words words = {"restore", video, "--out", out, "--quiet", "--no-sharpen"};
  words.insert(words.end(), more.begin(), more.end());
  return Unshimmer(folder, words);
}

inline cv::Mat FrameOf(const std::filesystem::path& path, int64_t k) {
  return OpenFrames(path)->Read(k).pixels;
}

inline void ExpectRefused(const Ran& ran, int exit_code, const Words& parts) {
  ExpectOneLine(ran, exit_code, parts, "unshimmer");
}

}  // namespace shimmer::restore::app
