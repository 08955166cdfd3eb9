#include "restore/app/evaluation/clip_run.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "restore/app/evaluation/clip_pictures.h"
#include "restore/app/evaluation/stage_meters.h"
#include "restore/app/frame_source.h"
#include "restore/levels.h"
#include "restore/translate.h"
#include "sim/dataset/interrupted.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What of the settings a look depends on.
std::string LookKey(const RestoreSettings& settings) {
  const RestoreParams& params = settings.params;
  return settings.flow + (params.stabilise ? " steady" : "") + (params.stack ? " stack" : "") +
         (params.method == SegmentMethod::kAof ? " aof" : "") + " register " +
         std::to_string(static_cast<int>(params.registered));
}

// What stabilising alone makes of a clip, its edges continued.
class SteadyFrames : public Frames {
 public:
  SteadyFrames(TurbFrames& video, const std::vector<FrameShift>& shifts, bool moved)
      : video_(video), shifts_(shifts), moved_(moved) {}
  int64_t count() override { return video_.count(); }
  cv::Mat Read(int64_t frame) override {
    const auto start = Clock::now();
    const cv::Mat turb = video_.Read(frame);
    const cv::Mat steady = moved_ ? Translated(turb, shifts_.at(static_cast<size_t>(frame)).px) : turb;
    seconds_ += SecondsSince(start);
    return steady;
  }
  double seconds() const { return seconds_; }

 private:
  TurbFrames& video_;
  const std::vector<FrameShift>& shifts_;
  bool moved_;
  double seconds_ = 0;
};

}  // namespace

cv::Mat TurbFrames::Read(int64_t frame) {
  if (stop_) throw dataset::Interrupted();
  const auto start = Clock::now();
  const cv::Mat turb = clip_.Turb(frame);
  seconds_ += SecondsSince(start);
  return turb;
}

ClipRun::ClipRun(TrueClip& clip, bool is_real, fs::path pictures, const std::atomic<bool>& stop)
    : clip_(clip), is_real_(is_real), pictures_(std::move(pictures)), stop_(stop), video_(clip, stop) {}

std::vector<ResultRow> ClipRun::Run(const Variant& variant, const RestoreTools& tools) {
  switch (variant.kind) {
    case VariantKind::kInput:
      return is_real_ ? std::vector<ResultRow>() : RunInput();
    case VariantKind::kBaseline:
      return RunBaseline(variant, tools);
    case VariantKind::kMethod:
      return RunMethod(variant);
    case VariantKind::kPipeline:
    case VariantKind::kAblation:
      break;
  }
  return RunPipeline(variant, tools);
}

const ClipRun::Look& ClipRun::LookBy(const RestoreSettings& settings, const RestoreTools& tools) {
  const std::string key = LookKey(settings);
  if (const auto known = looks_.find(key); known != looks_.end()) return known->second;
  const double read_s = video_.seconds();
  const auto start = Clock::now();
  Look look{.looked = LookAtVideo(video_, settings, tools, /*wants_strength=*/false, NoWatcher())};
  look.seconds = SecondsSince(start) - (video_.seconds() - read_s);
  return looks_.emplace(key, std::move(look)).first->second;
}

std::vector<ResultRow> ClipRun::RunInput() {
  SequenceMeter meter;
  for (int64_t k = 0; k < clip_.facts().frames; ++k) {
    if (stop_) throw dataset::Interrupted();
    meter.Add(InputFrameOf(clip_, k), TrueFrameOf(clip_, k, {}));
  }
  ResultRow row{kInputName, kResultStage, {}};
  meter.AddTo(row.measures);
  return {row};
}

std::vector<ResultRow> ClipRun::RunPipeline(const Variant& variant, const RestoreTools& tools) {
  const bool is_full = variant.kind == VariantKind::kPipeline;
  const Look& look = LookBy(variant.settings, tools);
  const VideoFacts& facts = look.looked.facts;
  const RestorePlan plan = PlanFor(look.looked, variant.settings, tools);
  StageMeters meters(plan, variant.name, is_full, is_full && is_real_);
  std::optional<ClipPictures> pictures;
  if (is_full) pictures.emplace(clip_, pictures_);
  StageTimes times;
  RestoreAsPlanned(
      video_, look.looked, plan, tools,
      [&](const FrameOnWay& frame) {
        const cv::Point2d found_px =
            plan.stabilise ? facts.shifts.at(static_cast<size_t>(frame.index)).px : cv::Point2d();
        const TrueFrame truth = TrueFrameOf(clip_, frame.index, found_px);
        meters.Add(frame, truth, clip_.Shake(frame.index), found_px);
        if (pictures) pictures->Add(frame, truth);
      },
      &times);
  if (pictures) pictures->Finish();
  const Value tilt_px = facts.scene ? Value(std::sqrt(facts.scene->strength.tilt_variance_px2)) : Value();
  return meters.Rows(times, look.seconds, clip_.facts().frames, tilt_px);
}

std::vector<ResultRow> ClipRun::RunBaseline(const Variant& variant, const RestoreTools& tools) {
  const LookedAt& looked = LookBy(variant.settings, tools).looked;
  const VideoFacts& facts = looked.facts;
  const bool moved = PlanFor(looked, variant.settings, tools).stabilise;  // as the pipeline does
  SteadyFrames steady(video_, facts.shifts, moved);
  SequenceMeter meter;
  double measuring_s = 0;
  int64_t k = 0;
  const auto start = Clock::now();
  RestoreSimply(variant.baseline, steady, [&](const cv::Mat& frame) {
    const auto measuring = Clock::now();
    const cv::Point2d found_px = moved ? facts.shifts[static_cast<size_t>(k)].px : cv::Point2d();
    meter.Add(frame, TrueFrameOf(clip_, k++, found_px));
    measuring_s += SecondsSince(measuring);
  });
  ResultRow row{variant.name, kResultStage, {}};
  meter.AddTo(row.measures);
  row.measures[Measure::kTime] =
      1000 * (SecondsSince(start) - measuring_s - steady.seconds()) / static_cast<double>(k);
  return {row};
}

std::vector<ResultRow> ClipRun::RunMethod(const Variant& variant) {
  const fs::path path = FindResults(variant.folder, clip_.facts().name);
  const auto results = OpenFrames(path, stop_);
  if (results->count() != clip_.facts().frames)
    throw std::invalid_argument(path.string() + ": has " + std::to_string(results->count()) +
                                " frames, must have " + std::to_string(clip_.facts().frames) +
                                " as the clip");
  SequenceMeter meter;
  for (int64_t k = 0; k < clip_.facts().frames; ++k) {
    if (stop_) throw dataset::Interrupted();
    const cv::Mat frame = results->Read(k).pixels;
    if (frame.size() != clip_.facts().size)
      throw std::invalid_argument(path.string() + ": is " + SizeText(frame.size()) + " px, must be " +
                                  SizeText(clip_.facts().size) + " as the clip");
    meter.Add(frame, TrueFrameOf(clip_, k, {}));
  }
  ResultRow row{variant.name, kResultStage, {}};
  meter.AddTo(row.measures);
  return {row};
}

fs::path FindResults(const fs::path& folder, const std::string& clip) {
  for (const fs::path& place : {folder / clip, folder / "clips" / clip})
    for (const char* end : {"", ".mp4", ".mkv", ".mov", ".avi", ".png"})
      if (fs::path path = place; fs::exists(path += end)) return path;
  throw std::invalid_argument(folder.string() + ": has no results of clip " + clip + ", must have " +
                              (folder / clip).string() + " or .mp4");
}

}  // namespace shimmer::restore::app
