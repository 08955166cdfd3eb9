#include "restore/app/frame_source.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "sim/dataset/image_io.h"
#include "sim/dataset/numbered_name.h"

namespace shimmer::restore::app {
namespace {

bool IsPicture(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return !extension.empty() && std::ranges::count(dataset::PictureExtensions(), extension.substr(1)) > 0;
}

}  // namespace

std::unique_ptr<dataset::FrameReader> OpenFrames(const std::filesystem::path& path,
                                                 const std::atomic<bool>& stop) {
  if (std::filesystem::is_directory(path)) return dataset::OpenSequence(path);
  if (std::filesystem::exists(path))
    return IsPicture(path) ? dataset::OpenStill(path) : dataset::OpenVideo(path, {}, stop);
  if (dataset::NumberedName::Parse(path.filename().string())) return dataset::OpenSequence(path);
  throw std::runtime_error(path.string() +
                           ": is not there, must be a picture, a folder of frames, a name with one %d or "
                           "%06d, or a video");
}

}  // namespace shimmer::restore::app
