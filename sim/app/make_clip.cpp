#include "sim/app/make_clip.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/app/clean_frames.h"
#include "sim/app/plan_text.h"
#include "sim/clip.h"
#include "sim/dataset/pixel_hash.h"

namespace shimmer::app {
namespace {

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

// A picture's file and its hash.
dataset::ClipFile PictureFile(std::string path, const cv::Mat& image, dataset::Encoding encoding) {
  return {std::move(path), dataset::EncodeImage(image, encoding), dataset::PixelHash(image, encoding)};
}

dataset::ClipFile TruthFile(std::string path, const sim::FrameTruth& frame,
                            const std::vector<std::string>& truth) {
  const auto wanted = [&](const char* kind) { return std::ranges::count(truth, kind) > 0; };
  std::vector<std::string> channels;
  std::vector<cv::Mat> planes;
  if (wanted("tilt")) {
    channels = {"dx", "dy"};
    cv::split(frame.tilt, planes);
  }
  if (wanted("sigma")) {
    channels.push_back("sigma");
    planes.push_back(frame.sigma);
  }
  cv::Mat picture;
  cv::merge(planes, picture);
  return {std::move(path), dataset::EncodeExr(picture, 32, channels),
          dataset::PixelHash(picture, {dataset::FileFormat::kExr, 32})};
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

}  // namespace

void MakeClip(const Job& job, int64_t clip, const std::atomic<bool>& stop,
              const std::function<void(const dataset::ClipFile&)>& keep, Json& line) {
  const Config config = job.config.Draw(static_cast<uint64_t>(clip), &line["drawn"]);
  const sim::ClipKey key{config.seed, static_cast<uint64_t>(clip)};
  CleanFrames clean(job.sources, *job.pictures, config, key, stop);
  line["source"] = clean.record();  // so far, should a frame turn out to be bad
  const sim::Scene scene = SceneOf(config, clean.still());
  const sim::ClipPlan plan = PlanOf(config, clean.still());
  const sim::ClipRenderer renderer(scene, plan, key);
  line["plan"] = PlanJson(plan);
  const sim::ClipFields& fields = renderer.fields();
  if (fields.tilt()) {
    line["tilt.origin_x"] = OriginsJson(fields.tilt()->x().octaves(), config.tilt.lattice);
    line["tilt.origin_y"] = OriginsJson(fields.tilt()->y().octaves(), config.tilt.lattice);
  }
  if (fields.blur_noise())
    line["blur.origin"] = OriginsJson(fields.blur_noise()->octaves().octaves(), config.tilt.lattice);

  const dataset::Layout layout = job.Layout();
  const dataset::Encoding encoding = EncodingOf(config.output);
  const bool one_clean_file = plan.read_once && layout.OneCleanFile();
  const std::vector<int64_t> times = KeptFrames(config);
  const bool with_truth = !config.output.truth.empty();
  FieldStatistics statistics;
  dataset::ClipFile turb, truth, clean_file;  // of the last frame that was computed
  std::optional<sim::CleanFrame> prepared;
  sim::RenderedFrame rendered;
  for (size_t k = 0; k < times.size(); ++k) {
    if (stop) throw Interrupted();
    if (k == 0 || !plan.render_once) {
      const cv::Mat frame = clean.Frame(times[k], plan.halo_px);
      if (k == 0 || !plan.read_once) prepared.emplace(renderer.Prepare(frame));
      renderer.Render(times[k], *prepared, with_truth, rendered);
      statistics.Add(rendered);
      turb = PictureFile("", rendered.turb, encoding);
      if (with_truth) truth = TruthFile("", *rendered.truth, config.output.truth);
      if (k == 0 || !plan.read_once)
        clean_file = PictureFile("", frame(cv::Rect({plan.halo_px, plan.halo_px}, config.size)), encoding);
    }
    const auto keep_as = [&](dataset::ClipFile& file, dataset::FrameKind kind) {
      file.path = layout.Path(kind, clip, static_cast<int64_t>(k));
      keep(file);
    };
    keep_as(turb, dataset::FrameKind::kTurb);
    if (k == 0 || !one_clean_file) keep_as(clean_file, dataset::FrameKind::kClean);
    if (with_truth) keep_as(truth, dataset::FrameKind::kTruth);
  }
  line["source"] = clean.record();
  line["tilt_rms_px"] = statistics.tilt_rms_px();
  line["mean_sigma_px"] = statistics.mean_sigma_px();
  line["size"] = {config.size.width, config.size.height};
  line["channels"] = rendered.turb.channels();
  line["frames"] = times.size();
}

}  // namespace shimmer::app
