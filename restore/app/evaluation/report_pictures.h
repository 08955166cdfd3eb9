// Pictures of clips: before and after on both sides of a line that is dragged, and a row over time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

inline constexpr size_t kClipsShown = 12;  // a page of them has some 10 MB

struct ShownClip {
  const ClipResult* clip;
  std::string id;                // of its part of the page
  std::filesystem::path folder;  // where its pictures are
};

// The first kClipsShown that have pictures of the input and of the result. ids: what their ids begin with.
std::vector<ShownClip> ClipsToShow(const std::vector<const ClipResult*>& clips,
                                   const std::filesystem::path& report, const std::string& ids);

std::string ShownClipsHtml(const std::vector<ShownClip>& shown);

}  // namespace shimmer::restore::app
