// Frames as a person names them on the command line.
#pragma once

#include <filesystem>
#include <memory>

#include "sim/dataset/frame_reader.h"
#include "sim/dataset/interrupted.h"

namespace shimmer::restore::app {

// path: a folder of frames, the folder of a clip that shimmer made (its turbulent frames), a picture, a
// video, or a name with one %d or %06d where there is no such file. Pictures are known by their extension;
// any other file is taken for a video. Throws std::runtime_error where it is none of these, or a number is
// missing between those of a folder's frames; dataset::Interrupted once stop is set, which must outlive the
// reader.
std::unique_ptr<dataset::FrameReader> OpenFrames(const std::filesystem::path& path,
                                                 const std::atomic<bool>& stop = dataset::kNeverStop);

}  // namespace shimmer::restore::app
