// Clips that others made.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "restore/app/evaluation/adapter.h"
#include "restore/app/evaluation/true_clip.h"
#include "restore/app/frame_source.h"
#include "restore/mask_scores.h"
#include "sim/dataset/npy.h"
#include "sim/dataset/numbered_name.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;
using dataset::FrameReader;

// RMS along an axis of all the fields of warp that there are; absent where there is none.
std::optional<double> TiltOf(const fs::path& fields) {
  const auto name = dataset::NumberedName::Parse(fields.filename().string());
  std::vector<fs::path> files;
  if (name)
    for (const int64_t number : dataset::NumbersIn(fields.parent_path(), *name))
      files.push_back(fields.parent_path() / name->Of(number));
  else
    files.push_back(fields);
  double squares = 0, count = 0;
  for (const fs::path& file : files) {
    const cv::Mat field = dataset::ReadNpy(file);
    if (field.channels() != 2) throw std::runtime_error(file.string() + ": must be rows x columns x 2");
    squares += cv::norm(field.reshape(1), cv::NORM_L2SQR);
    count += 2.0 * static_cast<double>(field.total());
  }
  if (count == 0) return {};
  return std::sqrt(squares / count);
}

ClipFacts WhatFramesSay(const std::string& name, FrameReader& frames) {
  return {.name = name,
          .frames = frames.count(),
          .size = frames.Read(0).pixels.size(),
          .tilt_rms_px = {},
          .shakes = {},
          .objects = {}};
}

class FilesClip : public TrueClip {
 public:
  FilesClip(const fs::path& folder, const Adapter& adapter, const std::string& clip,
            const std::atomic<bool>& stop)
      : margin_px_(adapter.margin_px) {
    turb_ = OpenFrames(folder / adapter.turb.Of(clip), stop);
    facts_ = WhatFramesSay(clip, *turb_);
    if (!adapter.clean.empty()) clean_ = Opened(folder / adapter.clean.Of(clip), stop);
    if (!adapter.mask.empty()) mask_ = Opened(folder / adapter.mask.Of(clip), stop);
    if (!adapter.warp.empty()) facts_.tilt_rms_px = TiltOf(folder / adapter.warp.Of(clip));
    if (adapter.frames > 0) facts_.frames = std::min(facts_.frames, adapter.frames);
  }

  const ClipFacts& facts() const override { return facts_; }
  int margin_px() const override { return margin_px_; }
  cv::Mat Turb(int64_t frame) override { return turb_->Read(frame).pixels; }
  std::optional<cv::Mat> Clean(int64_t frame) override { return FrameOf(clean_, frame); }
  std::optional<cv::Mat> Mask(int64_t frame) override {
    const std::optional<cv::Mat> mask = FrameOf(mask_, frame);
    return mask ? std::optional(MovingPixels(*mask)) : std::nullopt;
  }
  // Truth that others made is of the frames as they are: what shakes in them shakes in it.
  std::optional<cv::Point2d> Shake(int64_t) override { return {}; }

 private:
  std::unique_ptr<FrameReader> Opened(const fs::path& path, const std::atomic<bool>& stop) const {
    auto reader = OpenFrames(path, stop);
    if (reader->count() != facts_.frames && reader->count() != 1)
      throw std::runtime_error(path.string() + ": has " + std::to_string(reader->count()) +
                               " frames, must have " + std::to_string(facts_.frames) +
                               " as the turbulent ones, or 1");
    return reader;
  }

  std::optional<cv::Mat> FrameOf(const std::unique_ptr<FrameReader>& reader, int64_t frame) const {
    if (!reader) return {};
    cv::Mat pixels = reader->Read(reader->count() == 1 ? 0 : frame).pixels;
    if (pixels.size() != facts_.size)
      throw std::runtime_error("frame " + std::to_string(frame) +
                               " of the truth is of another size than the turbulent one");
    return pixels;
  }

  int margin_px_;
  std::unique_ptr<FrameReader> turb_, clean_, mask_;
  ClipFacts facts_;
};

class AdapterClips : public ClipSet {
 public:
  AdapterClips(fs::path folder, Adapter adapter, const std::atomic<bool>& stop)
      : folder_(std::move(folder)), adapter_(std::move(adapter)), stop_(stop) {
    names_ = adapter_.ClipsIn(folder_);
    if (names_.empty())
      throw std::invalid_argument(folder_.string() + ": has no clips as " + adapter_.turb.text);
  }

  const std::vector<std::string>& names() const override { return names_; }
  int64_t count() const override { return std::ssize(names_); }
  std::unique_ptr<TrueClip> Open(size_t clip) const override {
    return std::make_unique<FilesClip>(folder_, adapter_, names_.at(clip), stop_);
  }
  nlohmann::json Identity() const override { return {{"adapter", adapter_.json}}; }

 private:
  fs::path folder_;
  Adapter adapter_;
  const std::atomic<bool>& stop_;
  std::vector<std::string> names_;
};

class RealClip : public TrueClip {
 public:
  RealClip(const fs::path& video, const std::string& name, const std::atomic<bool>& stop)
      : frames_(OpenFrames(video, stop)) {
    facts_ = WhatFramesSay(name, *frames_);
  }
  const ClipFacts& facts() const override { return facts_; }
  cv::Mat Turb(int64_t frame) override { return frames_->Read(frame).pixels; }
  std::optional<cv::Mat> Clean(int64_t) override { return {}; }
  std::optional<cv::Mat> Mask(int64_t) override { return {}; }
  std::optional<cv::Point2d> Shake(int64_t) override { return {}; }

 private:
  std::unique_ptr<FrameReader> frames_;
  ClipFacts facts_;
};

class RealVideos : public ClipSet {
 public:
  RealVideos(std::vector<fs::path> videos, const std::atomic<bool>& stop)
      : videos_(std::move(videos)), stop_(stop) {
    std::map<std::string, int> times;
    for (const fs::path& video : videos_) {
      OpenFrames(video, stop);  // is it one?
      // (a folder may be given with a slash at its end, or as "..")
      const fs::path whole = fs::absolute(video).lexically_normal();
      const std::string stem = (whole.has_filename() ? whole : whole.parent_path()).stem().string();
      const int time = ++times[stem];
      names_.push_back(time == 1 ? stem : stem + "-" + std::to_string(time));
    }
  }

  const std::vector<std::string>& names() const override { return names_; }
  int64_t count() const override { return std::ssize(names_); }
  std::unique_ptr<TrueClip> Open(size_t clip) const override {
    return std::make_unique<RealClip>(videos_.at(clip), names_.at(clip), stop_);
  }
  nlohmann::json Identity() const override { return nullptr; }

 private:
  std::vector<fs::path> videos_;
  const std::atomic<bool>& stop_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<ClipSet> OpenWithAdapter(const fs::path& folder, const fs::path& adapter,
                                         const std::atomic<bool>& stop) {
  return std::make_unique<AdapterClips>(folder, ReadAdapter(adapter), stop);
}

std::unique_ptr<ClipSet> OpenRealVideos(const std::vector<fs::path>& videos, const std::atomic<bool>& stop) {
  return std::make_unique<RealVideos>(videos, stop);
}

}  // namespace shimmer::restore::app
