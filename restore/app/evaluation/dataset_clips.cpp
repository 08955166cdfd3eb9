// Clips that shimmer generated.
#include <cmath>
#include <stdexcept>

#include "restore/app/evaluation/true_clip.h"
#include "restore/mask_scores.h"
#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/numbered_name.h"

namespace shimmer::restore::app {
namespace {

using dataset::DatasetReader;
using dataset::Json;

std::string NameOfClip(int64_t clip) { return dataset::Padded(clip, 6); }

bool Shakes(const std::vector<cv::Point2d>& shifts) {
  return std::ranges::any_of(shifts, [](const cv::Point2d& s) { return s != cv::Point2d(); });
}

class DatasetClip : public TrueClip {
 public:
  DatasetClip(const DatasetReader& reader, int64_t clip)
      : reader_(reader), clip_(clip), files_(reader.Files(clip)), shake_(reader.TruthShake(clip)) {
    const Json line = reader.Line(clip);
    const bool still = files_.clean.size() == 1 && !line.contains("objects");
    is_still_ = still;
    facts_ = {.name = NameOfClip(clip),
              .frames = std::ssize(files_.turb),
              .size = ReadSamples(files_.turb.at(0)).size(),
              .tilt_rms_px = line.at("tilt_rms_px").get<double>(),
              .shakes = shake_ ? Shakes(*shake_) : false,
              .objects = {}};
    if (still)
      facts_.objects = 0;
    else if (line.contains("objects"))
      facts_.objects = static_cast<int>(line.at("objects").size());
  }

  const ClipFacts& facts() const override { return facts_; }
  cv::Mat Turb(int64_t frame) override { return ReadSamples(files_.turb.at(static_cast<size_t>(frame))); }

  std::optional<cv::Mat> Clean(int64_t frame) override {
    return ReadSamples(files_.clean.at(files_.clean.size() == 1 ? 0 : static_cast<size_t>(frame)));
  }

  std::optional<cv::Mat> Mask(int64_t frame) override {
    if (const auto mask = reader_.TruthMask(clip_, frame)) return MovingPixels(*mask);
    if (is_still_) return cv::Mat::zeros(facts_.size, CV_8UC1);
    return {};
  }

  std::optional<cv::Point2d> Shake(int64_t frame) override {
    return shake_ ? shake_->at(static_cast<size_t>(frame)) : cv::Point2d();
  }

 private:
  cv::Mat ReadSamples(const dataset::StoredFile& file) const {
    return dataset::ReadSamples(reader_.folder() / file.name(), reader_.Bytes(file)).pixels;
  }

  const DatasetReader& reader_;
  int64_t clip_;
  dataset::ClipFiles files_;
  std::optional<std::vector<cv::Point2d>> shake_;
  bool is_still_ = false;
  ClipFacts facts_;
};

class DatasetClips : public ClipSet {
 public:
  explicit DatasetClips(const std::filesystem::path& folder) : reader_(folder) {
    for (const int64_t clip : reader_.clips()) {
      RequireShake(clip);
      clips_.push_back(clip);
      names_.push_back(NameOfClip(clip));
    }
    if (clips_.empty()) throw std::invalid_argument(folder.string() + ": none of its clips is done");
  }

  const std::vector<std::string>& names() const override { return names_; }
  int64_t count() const override { return reader_.description().at("config").at("clips").get<int64_t>(); }
  std::unique_ptr<TrueClip> Open(size_t clip) const override {
    return std::make_unique<DatasetClip>(reader_, clips_.at(clip));
  }
  Json Identity() const override {
    return {{"config_hash", reader_.description().at("config_hash")},
            {"engine", reader_.description().at("engine")}};
  }

 private:
  // Without it the clean frames are of another place than the turbulent ones.
  void RequireShake(int64_t clip) const {
    const Json line = reader_.Line(clip);
    const double rms_px = line.value("shake_rms_px", 0.0);
    if (rms_px == 0 || !reader_.Files(clip).shake.empty()) return;
    throw std::invalid_argument(reader_.folder().string() + ": the camera of clip " + std::to_string(clip) +
                                " shakes, and its shifts were not written: output.truth must name \"shake\"");
  }

  DatasetReader reader_;
  std::vector<int64_t> clips_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<ClipSet> OpenDataset(const std::filesystem::path& folder) {
  return std::make_unique<DatasetClips>(folder);
}

}  // namespace shimmer::restore::app
