#include "sim/dataset/dataset_reader.h"

#include <algorithm>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

const std::string& FileOfFrame(const std::vector<std::string>& files, int64_t clip, int64_t frame) {
  if (frame < 0 || frame >= static_cast<int64_t>(files.size()))
    throw std::invalid_argument("frame " + std::to_string(frame) + " of clip " + std::to_string(clip) +
                                ": there are " + std::to_string(files.size()));
  return files[frame];
}

}  // namespace

DatasetReader::DatasetReader(fs::path folder)
    : folder_(std::move(folder)),
      description_(ReadDescription(folder_)),
      manifest_(folder_ / kManifestName) {}

ClipFiles DatasetReader::Files(int64_t clip) const {
  if (!clips().contains(clip))
    throw std::invalid_argument(folder_.string() + ": clip " + std::to_string(clip) +
                                " is not in this data set");
  ClipFiles files;
  const Json line = Line(clip);
  for (const Json& file : line.value("files", Json::array())) {
    if (!file.is_object() || !file.contains("path") || !file["path"].is_string())
      throw std::runtime_error((folder_ / kManifestName).string() + ": clip " + std::to_string(clip) +
                               ": damaged line, each of its files must have a path");
    const auto path = file["path"].get<std::string>();
    const std::string kind = fs::path(path).parent_path().filename().string();
    if (kind == "turb")
      files.turb.push_back(path);
    else if (kind == "clean" || kind == "noturb")
      files.clean.push_back(path);
    else if (kind == "truth")
      files.truth.push_back(path);
  }
  // Numbers grow by a digit where they have to (sequence): shorter names come first.
  const auto by_number = [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  };
  for (auto* paths : {&files.turb, &files.clean, &files.truth}) std::ranges::sort(*paths, by_number);
  return files;
}

int64_t DatasetReader::FrameCount(int64_t clip) const {
  return static_cast<int64_t>(Files(clip).turb.size());
}

Picture DatasetReader::Turb(int64_t clip, int64_t frame) const {
  return ReadImage(folder_ / FileOfFrame(Files(clip).turb, clip, frame));
}

Picture DatasetReader::Clean(int64_t clip, int64_t frame) const {
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);  // a frame that the clip has
  return ReadImage(folder_ / FileOfFrame(files.clean, clip, files.clean.size() == 1 ? 0 : frame));
}

std::optional<cv::Mat> DatasetReader::Truth(int64_t clip, int64_t frame,
                                            std::span<const std::string> channels) const {
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);
  if (files.truth.empty()) return {};
  cv::Mat truth = ReadChannels(folder_ / FileOfFrame(files.truth, clip, frame), channels);
  if (truth.empty()) return {};
  return truth;
}

std::optional<cv::Mat> DatasetReader::TruthTilt(int64_t clip, int64_t frame) const {
  static const std::vector<std::string> channels = {"dx", "dy"};
  return Truth(clip, frame, channels);
}

std::optional<cv::Mat> DatasetReader::TruthSigma(int64_t clip, int64_t frame) const {
  static const std::vector<std::string> channels = {"sigma"};
  return Truth(clip, frame, channels);
}

}  // namespace shimmer::dataset
