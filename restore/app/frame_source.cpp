#include "restore/app/frame_source.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>

#include "sim/dataset/image_io.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/sources.h"

namespace shimmer::restore::app {
namespace {

// The last number in a file's name, before its extension.
std::optional<int64_t> LastNumber(const std::filesystem::path& file) {
  const std::string name = file.stem().string(), digits = "0123456789";
  const size_t end = name.find_last_of(digits);
  if (end == std::string::npos) return {};
  const size_t before = name.find_last_not_of(digits, end),
               begin = before == std::string::npos ? 0 : before + 1;
  const std::string number = name.substr(begin, end + 1 - begin);
  return number.size() > 18 ? std::nullopt : std::optional<int64_t>(std::stoll(number));
}

bool IsPicture(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return !extension.empty() && std::ranges::count(dataset::PictureExtensions(), extension.substr(1)) > 0;
}

// Frames that are numbered one after the other, or each so many after the one before: one that was lost would
// shift all that follow it in time.
void RequireNoGap(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> files = dataset::SequenceFiles(folder);
  std::vector<int64_t> numbers;
  for (const std::filesystem::path& file : files)
    if (const auto number = LastNumber(file)) numbers.push_back(*number);
  if (numbers.size() != files.size() || files.size() < 2) return;
  int64_t step = INT64_MAX;
  for (size_t i = 1; i < numbers.size(); ++i) step = std::min(step, numbers[i] - numbers[i - 1]);
  for (size_t i = 1; i < numbers.size(); ++i)
    if (numbers[i] - numbers[i - 1] > std::max<int64_t>(step, 1))
      throw std::runtime_error(folder.string() + ": has no frame between " +
                               files[i - 1].filename().string() + " and " + files[i].filename().string() +
                               ", must be numbered without gaps");
}

}  // namespace

std::unique_ptr<dataset::FrameReader> OpenFrames(const std::filesystem::path& path,
                                                 const std::atomic<bool>& stop) {
  if (std::filesystem::is_directory(path)) {
    const std::filesystem::path turb = path / "turb",
                                frames = std::filesystem::is_directory(turb) ? turb : path;
    RequireNoGap(frames);
    return dataset::OpenSequence(frames);
  }
  if (std::filesystem::exists(path))
    return IsPicture(path) ? dataset::OpenStill(path) : dataset::OpenVideo(path, {}, stop);
  if (dataset::NumberedName::Parse(path.filename().string())) return dataset::OpenSequence(path);
  throw std::runtime_error(path.string() +
                           ": is not there, must be a picture, a folder of frames, a name with one %d or "
                           "%06d, or a video");
}

}  // namespace shimmer::restore::app
