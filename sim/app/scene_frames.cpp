#include "sim/app/scene_frames.h"

namespace shimmer::app {
namespace {

// Of floats that a file holds as halves; all other samples are a file's own already.
sim::Rounding RoundingOf(const OutputParams& output) {
  const dataset::Encoding encoding = EncodingOf(output);
  if (encoding.format != dataset::FileFormat::kExr || encoding.bits != 16) return {};
  return [encoding](cv::Mat& samples) { dataset::Quantise(samples, encoding).copyTo(samples); };
}

}  // namespace

SceneFrames::SceneFrames(const Job& job, const Config& config, sim::ClipKey key,
                         const std::atomic<bool>& stop, Json& line)
    : config_(config), background_(job.sources, *job.pictures, config, key, stop) {
  line["source"] = background_.record();  // so far, should a frame turn out to be bad
  objects_ = ObjectsOf(job, config, key, stop);
  if (!objects_.record.empty()) line["objects"] = objects_.record;
  shake_ = sim::ShakePath(config.camera, key, config.frames);
}

void SceneFrames::Use(const sim::ClipPlan& plan) {
  plan_ = plan;
  if (plan_.objects > 0) scene_.emplace(std::move(objects_.placed), plan_, RoundingOf(config_.output));
}

SceneFrames::Frame SceneFrames::At(int64_t t) {
  Frame frame{.clean = nullptr, .steady = {}, .shake_px = ShakeAt(t), .objects = {}};
  if (scene_) frame.objects = scene_->At(t - config_.first_frame);
  const int around_px = plan_.AroundPx();
  const cv::Point origin(-around_px, -around_px);
  if (still() && scene_) {
    if (!composed_) composed_.emplace(background_.Frame(t, around_px), origin, plan_);
    frame.clean = &composed_->With(*frame.objects);
  } else if (!still() || !prepared_) {
    cv::Mat samples = background_.Frame(t, around_px);
    if (scene_) frame.objects->Over(samples, origin);
    if (still()) {
      prepared_.emplace(samples, origin, plan_);
    } else {  // no more of it than this frame needs
      const cv::Rect window = plan_.Window(frame.shake_px) | cv::Rect({}, config_.size);
      prepared_.emplace(samples(window - origin), window.tl(), plan_);
    }
  }
  if (!frame.clean) frame.clean = &*prepared_;
  frame.steady = frame.clean->samples(cv::Rect(-frame.clean->origin, config_.size));
  return frame;
}

sim::FrameView SceneFrames::ViewOf(const Frame& frame, int border_px) const {
  sim::FrameView view{.shake_px = frame.shake_px};
  if (plan_.own_distances)
    view.strength = frame.objects->Strength(
        {-border_px, -border_px, config_.size.width + 2 * border_px, config_.size.height + 2 * border_px},
        frame.shake_px);
  return view;
}

cv::Mat SceneFrames::Mask(int64_t t, const Frame& frame) {
  const cv::Mat own = background_.Mask(t),
                objects = frame.objects ? frame.objects->Mask() : cv::Mat::zeros(config_.size, CV_32FC1);
  if (own.empty()) return objects;
  return objects + own.mul(1 - objects);
}

cv::Mat SceneFrames::Flow(const Frame& frame) const {
  return frame.objects ? frame.objects->Flow() : cv::Mat::zeros(config_.size, CV_32FC2);
}

}  // namespace shimmer::app
