// The program `unshimmer` as people call it.
#pragma once

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

inline void ExpectRefused(const Ran& ran, int exit_code, const Words& parts) {
  ExpectOneLine(ran, exit_code, parts, "unshimmer");
}

}  // namespace shimmer::restore::app
