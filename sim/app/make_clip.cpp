#include "sim/app/make_clip.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/app/clip_truth.h"
#include "sim/app/frame_compression.h"
#include "sim/app/plan_text.h"
#include "sim/app/scene_frames.h"
#include "sim/clip.h"
#include "sim/row_sums.h"
#include "sim/rows.h"

namespace shimmer::app {
namespace {

using dataset::FrameKind;

Json OriginJson(const noise::Origin& origin) {
  return {origin[0].ToDouble(), origin[1].ToDouble(), origin[2].ToDouble()};
}

// classic: the one origin [x, y, t]; seeded: one per octave.
Json OriginsJson(const std::vector<noise::Octave>& octaves, sim::LatticeKind lattice) {
  if (lattice == sim::LatticeKind::kClassic) return OriginJson(octaves.front().origin);
  Json origins = Json::array();
  for (const noise::Octave& octave : octaves) origins.push_back(OriginJson(octave.origin));
  return origins;
}

// The frames of a clip that are kept: all, or for pairs frames_per_clip of them, evenly spread.
std::vector<int64_t> KeptFrames(const Config& config) {
  const int kept = KeptFrameCount(config);
  std::vector<int64_t> frames;
  for (int64_t k = 0; k < kept; ++k) frames.push_back(config.first_frame + k * config.frames / kept);
  return frames;
}

// What the manifest says of the turbulence itself.
class FieldStatistics {
 public:
  void Add(const sim::RenderedFrame& frame) {
    tilt_square_px2_ += frame.tilt_square_px2;
    sigma_px_ += frame.mean_sigma_px;
    ++frames_;
  }
  double tilt_rms_px() const { return std::sqrt(tilt_square_px2_ / frames_); }
  double mean_sigma_px() const { return sigma_px_ / frames_; }

 private:
  double tilt_square_px2_ = 0, sigma_px_ = 0;
  int frames_ = 0;
};

// The turbulence-free twin of a clip whose clean frames shall shake too.
sim::Scene WithoutTurbulence(sim::Scene scene) {
  scene.tilt.strength_px = 0;
  scene.blur.min_sigma_px = scene.blur.max_sigma_px = 0;
  scene.sensor = {};
  scene.own_distances = false;
  return scene;
}

// One clip on its way.
class ClipMaker {
 public:
  ClipMaker(const Job& job, int64_t clip, const std::atomic<bool>& stop,
            const std::function<void(const dataset::ClipFile&)>& keep, Json& line)
      : clip_(clip),
        config_(job.config.Draw(static_cast<uint64_t>(clip), &line["drawn"])),
        key_{config_.seed, static_cast<uint64_t>(clip)},
        stop_(stop),
        keep_(keep),
        line_(line),
        layout_(job.Layout()),
        encoding_(EncodingOf(config_.output)),
        truth_(dataset::TruthKinds(config_.output.truth)),
        frames_(job, config_, key_, stop, line),
        scene_(SceneOf(config_, frames_.still())),
        plan_(PlanOf(config_, frames_.still())),
        renderer_(scene_, plan_, key_),
        compression_(config_) {
    frames_.Use(plan_);
    line_["plan"] = PlanJson(plan_);
    if (config_.camera.shaken_clean && plan_.shake) {
      const sim::Scene clear = WithoutTurbulence(scene_);
      shaken_.emplace(clear, sim::PlanClip(clear, plan_.shape, config_.accuracy), key_);
    }
    clean_changes_ = !plan_.read_once || plan_.objects > 0 || shaken_;
    NoteOrigins();
  }

  void Make() {
    const std::vector<int64_t> times = KeptFrames(config_);
    const bool one_clean = !clean_changes_ && layout_.OneCleanFile();
    std::vector<cv::Point2d> shifts;
    for (size_t k = 0; k < times.size(); ++k) {
      if (stop_) throw Interrupted();
      if (k == 0 || !plan_.render_once || Writes(FrameKind::kMask) || Writes(FrameKind::kFlow))
        MakeFrame(times[k], k == 0);
      Keep(turb_, FrameKind::kTurb, k);
      if (k == 0 || !one_clean) Keep(clean_, FrameKind::kClean, k);
      if (Writes(FrameKind::kTruth)) Keep(fields_, FrameKind::kTruth, k);
      if (Writes(FrameKind::kMask)) Keep(mask_, FrameKind::kMask, k);
      if (Writes(FrameKind::kFlow) && k + 1 < times.size()) Keep(flow_, FrameKind::kFlow, k);
      shifts.push_back(frames_.ShakeAt(times[k]));
    }
    if (Writes(FrameKind::kShake)) {
      dataset::ClipFile file = ShakeFile(shifts);
      Keep(file, FrameKind::kShake, 0);
    }
    line_["source"] = frames_.record();
    line_["tilt_rms_px"] = statistics_.tilt_rms_px();
    line_["mean_sigma_px"] = statistics_.mean_sigma_px();
    if (plan_.shake) line_["shake_rms_px"] = RmsOf(shifts);
    if (Writes(FrameKind::kMask)) line_["moving_share"] = moving_share_ / static_cast<double>(times.size());
    line_["size"] = {config_.size.width, config_.size.height};
    line_["channels"] = rendered_.turb.channels();
    line_["frames"] = times.size();
  }

 private:
  bool Writes(FrameKind kind) const { return truth_.contains(kind); }

  void Keep(dataset::ClipFile& file, FrameKind kind, size_t k) {
    file.path = layout_.Path(kind, clip_, static_cast<int64_t>(k));
    keep_(file);
  }

  // The files of a frame, into the members.
  void MakeFrame(int64_t t, bool first) {
    const SceneFrames::Frame frame = frames_.At(t);
    const sim::FrameView view = frames_.ViewOf(frame, renderer_.fields().border_px());
    if (first || !plan_.render_once) {
      renderer_.Render(t, *frame.clean, Writes(FrameKind::kTruth), rendered_, view);
      statistics_.Add(rendered_);
      turb_ = PictureFile(compression_.Through(rendered_.turb), encoding_);
      if (Writes(FrameKind::kTruth)) fields_ = TruthFile(*rendered_.truth, config_.output.truth);
    }
    if (first || clean_changes_) {
      if (shaken_) shaken_->Render(t, *frame.clean, false, shaken_frame_, {.shake_px = view.shake_px});
      clean_ = PictureFile(shaken_ ? shaken_frame_.turb : frame.steady, encoding_);
    }
    if (Writes(FrameKind::kMask)) {
      const cv::Mat mask = frames_.Mask(t, frame);
      double covered = 0;
      for (int y = 0; y < mask.rows; ++y) covered += sim::SumOfRow(sim::RowOf(mask, y));
      moving_share_ += covered / static_cast<double>(config_.size.area());
      mask_ = MaskFile(mask);
    }
    if (Writes(FrameKind::kFlow)) flow_ = FlowFile(frames_.Flow(frame));
  }

  void NoteOrigins() {
    const sim::ClipFields& fields = renderer_.fields();
    if (fields.tilt()) {
      line_["tilt.origin_x"] = OriginsJson(fields.tilt()->x().octaves(), config_.tilt.lattice);
      line_["tilt.origin_y"] = OriginsJson(fields.tilt()->y().octaves(), config_.tilt.lattice);
    }
    if (fields.blur_noise())
      line_["blur.origin"] = OriginsJson(fields.blur_noise()->octaves().octaves(), config_.tilt.lattice);
  }

  static double RmsOf(const std::vector<cv::Point2d>& shifts) {
    double square = 0;
    for (const cv::Point2d& shift : shifts) square += shift.dot(shift);
    return std::sqrt(square / static_cast<double>(shifts.size()));
  }

  const int64_t clip_;
  const Config config_;
  const sim::ClipKey key_;
  const std::atomic<bool>& stop_;
  const std::function<void(const dataset::ClipFile&)>& keep_;
  Json& line_;
  const dataset::Layout layout_;
  const dataset::Encoding encoding_;
  const std::set<FrameKind> truth_;
  SceneFrames frames_;
  const sim::Scene scene_;
  const sim::ClipPlan plan_;
  const sim::ClipRenderer renderer_;
  std::optional<sim::ClipRenderer> shaken_;
  bool clean_changes_ = false;  // from frame to frame
  FrameCompression compression_;
  FieldStatistics statistics_;
  double moving_share_ = 0;
  sim::RenderedFrame rendered_, shaken_frame_;
  dataset::ClipFile turb_, clean_, fields_, mask_, flow_;  // of the last frame that was made
};

}  // namespace

void MakeClip(const Job& job, int64_t clip, const std::atomic<bool>& stop,
              const std::function<void(const dataset::ClipFile&)>& keep, Json& line) {
  ClipMaker(job, clip, stop, keep, line).Make();
}

}  // namespace shimmer::app
