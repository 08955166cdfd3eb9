#include "sim/dataset/dataset_reader.h"

#include <algorithm>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"
#include "sim/dataset/layout.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

const StoredFile& FileOfFrame(const std::vector<StoredFile>& files, int64_t clip, int64_t frame) {
  if (frame < 0 || frame >= static_cast<int64_t>(files.size()))
    throw std::invalid_argument("frame " + std::to_string(frame) + " of clip " + std::to_string(clip) +
                                ": there are " + std::to_string(files.size()));
  return files[frame];
}

std::vector<StoredFile>& FilesOf(FrameKind kind, ClipFiles& files) {
  switch (kind) {
    case FrameKind::kTurb:
      return files.turb;
    case FrameKind::kClean:
      return files.clean;
    case FrameKind::kTruth:
      return files.truth;
    case FrameKind::kMask:
      return files.mask;
    case FrameKind::kFlow:
      return files.flow;
    case FrameKind::kShake:
      break;
  }
  return files.shake;
}

}  // namespace

DatasetReader::DatasetReader(fs::path folder, const Manifest::Damaged& damaged)
    : folder_(std::move(folder)),
      description_(ReadDescription(folder_)),
      manifest_(ManifestsIn(folder_), damaged) {}

ClipFiles DatasetReader::Files(int64_t clip) const {
  if (!clips().contains(clip))
    throw std::invalid_argument(folder_.string() + ": clip " + std::to_string(clip) +
                                " is not in this data set");
  ClipFiles files;
  for (StoredFile& file : FilesOfLine(Line(clip))) {
    const auto kind = KindOfPath(file.name());
    if (!kind) continue;
    FilesOf(*kind, files).push_back(std::move(file));
  }
  // Numbers grow by a digit where they have to (sequence): shorter names come first.
  const auto by_number = [](const StoredFile& a, const StoredFile& b) {
    const std::string name_a = a.name(), name_b = b.name();
    return name_a.size() != name_b.size() ? name_a.size() < name_b.size() : name_a < name_b;
  };
  for (const FrameKind kind : kFrameKinds) std::ranges::sort(FilesOf(kind, files), by_number);
  return files;
}

int64_t DatasetReader::FrameCount(int64_t clip) const {
  return static_cast<int64_t>(Files(clip).turb.size());
}

std::vector<uint8_t> DatasetReader::Bytes(const StoredFile& file) const {
  if (file.member.empty()) return ReadFile(folder_ / file.path);
  return ReadPart(folder_ / file.path, static_cast<uint64_t>(file.offset), static_cast<size_t>(file.bytes));
}

Picture DatasetReader::Read(const StoredFile& file) const {
  return file.member.empty() ? ReadImage(folder_ / file.path) : ReadImage(folder_ / file.name(), Bytes(file));
}

Picture DatasetReader::Turb(int64_t clip, int64_t frame) const {
  return Read(FileOfFrame(Files(clip).turb, clip, frame));
}

Picture DatasetReader::Clean(int64_t clip, int64_t frame) const {
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);  // a frame that the clip has
  return Read(FileOfFrame(files.clean, clip, files.clean.size() == 1 ? 0 : frame));
}

std::optional<cv::Mat> DatasetReader::Channels(const StoredFile& file,
                                               std::span<const std::string> channels) const {
  cv::Mat read = file.member.empty() ? ReadChannels(folder_ / file.path, channels)
                                     : ReadChannels(folder_ / file.name(), channels, Bytes(file));
  if (read.empty()) return {};
  return read;
}

std::optional<cv::Mat> DatasetReader::Truth(int64_t clip, int64_t frame,
                                            std::span<const std::string> channels) const {
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);
  if (files.truth.empty()) return {};
  return Channels(FileOfFrame(files.truth, clip, frame), channels);
}

std::optional<cv::Mat> DatasetReader::TruthMask(int64_t clip, int64_t frame) const {
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);
  if (files.mask.empty()) return {};
  return Read(FileOfFrame(files.mask, clip, frame)).pixels;
}

std::optional<cv::Mat> DatasetReader::TruthFlow(int64_t clip, int64_t frame) const {
  static const std::vector<std::string> channels(kFlowChannels.begin(), kFlowChannels.end());
  const ClipFiles files = Files(clip);
  FileOfFrame(files.turb, clip, frame);
  if (frame >= static_cast<int64_t>(files.flow.size())) return {};
  const StoredFile& file = files.flow[static_cast<size_t>(frame)];
  std::optional<cv::Mat> flow = Channels(file, channels);
  if (!flow) throw std::runtime_error((folder_ / file.name()).string() + ": must have the channels u and v");
  return flow;
}

std::optional<std::vector<cv::Point2d>> DatasetReader::TruthShake(int64_t clip) const {
  const ClipFiles files = Files(clip);
  if (files.shake.empty()) return {};
  const std::vector<uint8_t> bytes = Bytes(files.shake.front());
  std::vector<cv::Point2d> shake;
  try {
    const Json json = Json::parse(bytes);
    for (const Json& shift : json.at(kShakeKey))
      shake.emplace_back(shift.at(0).get<double>(), shift.at(1).get<double>());
  } catch (const Json::exception&) {
    shake.clear();
  }
  if (shake.size() != files.turb.size())
    throw std::runtime_error((folder_ / files.shake.front().name()).string() + ": must be {\"" + kShakeKey +
                             "\": [[x, y], ...]} with " + std::to_string(files.turb.size()) + " shifts");
  return shake;
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
