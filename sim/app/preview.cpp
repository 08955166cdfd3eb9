#include "sim/app/preview.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "sim/app/clean_frames.h"
#include "sim/app/job.h"
#include "sim/app/scene_marks.h"
#include "sim/app/sheet.h"
#include "sim/camera.h"
#include "sim/clip_fields.h"
#include "sim/colour.h"
#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/files.h"

namespace shimmer::app {
namespace {

constexpr int kMostGifFrames = 200, kGifDelayMs = 80, kGifFramePx = 512;

// Frame `kept` of a clip in the data set, as time in its config.
int64_t TimeOf(const Config& config, int64_t kept, int64_t kept_frames) {
  return config.first_frame + kept * config.frames / kept_frames;
}

std::string Label(int64_t clip, int64_t frame, const Config& config, const std::optional<SceneMarks>& marks) {
  char text[160];
  std::snprintf(text, sizeof text, "clip %lld  frame %lld   S %.2f px   f %.4f   sigma %.2f-%.2f px",
                static_cast<long long>(clip), static_cast<long long>(frame), config.tilt.strength_px,
                config.tilt.base_frequency, config.blur.min_sigma_px, config.blur.max_sigma_px);
  const std::string shake = marks ? marks->Label() : "";
  return shake.empty() ? text : text + ("   " + shake);
}

// Up to `rows` clips, evenly spread.
std::vector<int64_t> SomeClips(const std::set<int64_t>& clips, int rows) {
  const std::vector<int64_t> all(clips.begin(), clips.end());
  const size_t count = std::min(all.size(), static_cast<size_t>(rows));
  std::vector<int64_t> some;
  for (size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

class Previewer {
 public:
  explicit Previewer(const dataset::DatasetReader& reader)
      : reader_(reader),
        config_(ConfigOfDataset(reader.folder(), reader.description())),
        same_engine_(reader.description().value("engine", 0) == kEngine) {
    if (reader.clips().empty())
      throw std::runtime_error(reader.folder().string() + ": has no clip that is done");
  }

  cv::Mat Sheet(int rows) const {
    std::vector<SheetRow> sheet;
    for (int64_t clip : SomeClips(reader_.clips(), rows)) sheet.push_back(Row(clip));
    return DrawSheet(sheet);
  }

  std::vector<cv::Mat> Frames(int64_t clip) const {
    if (clip < 0) clip = *reader_.clips().begin();
    const Config config = config_.Draw(static_cast<uint64_t>(clip), nullptr);
    const Shakes shakes = ShakesOf(clip, config);
    std::vector<cv::Mat> frames;
    for (int64_t k = 0; k < std::min<int64_t>(reader_.FrameCount(clip), kMostGifFrames); ++k) {
      const std::optional<SceneMarks> marks = MarksOf(clip, k, shakes);
      frames.push_back(DrawClipFrame(Small(ForTheEye(reader_.Clean(clip, k))),
                                     Small(ForTheEye(reader_.Turb(clip, k))), Label(clip, k, config, marks),
                                     marks));
    }
    return frames;
  }

 private:
  // Of each frame that is kept. Empty where it is not known.
  struct Shakes {
    std::vector<cv::Point2d> shifts_px;
    bool written = false;  // as truth
  };

  Shakes ShakesOf(int64_t clip, const Config& config) const {
    if (auto truth = reader_.TruthShake(clip)) return {std::move(*truth), true};
    const auto frames = static_cast<size_t>(reader_.FrameCount(clip));
    if (config.camera.shake == sim::Shake::kNone) return {std::vector<cv::Point2d>(frames), false};
    if (!same_engine_) return {};
    const auto path =
        sim::ShakePath(config.camera, {config.seed, static_cast<uint64_t>(clip)}, config.frames);
    Shakes shakes;
    for (size_t k = 0; k < frames; ++k)
      shakes.shifts_px.push_back(path.at(static_cast<size_t>(
          TimeOf(config, static_cast<int64_t>(k), static_cast<int64_t>(frames)) - config.first_frame)));
    return shakes;
  }

  // None where the set has no truth of a moving scene.
  std::optional<SceneMarks> MarksOf(int64_t clip, int64_t frame, const Shakes& shakes) const {
    const auto mask = reader_.TruthMask(clip, frame);
    if (!mask && !shakes.written) return {};
    SceneMarks marks{.mask = mask.value_or(cv::Mat()), .place = static_cast<size_t>(frame)};
    if (!shakes.shifts_px.empty()) marks.turb_shake_px = shakes.shifts_px.at(marks.place);
    marks.clean_shake_px = config_.fixed().camera.shaken_clean ? marks.turb_shake_px : cv::Point2d();
    if (shakes.written) marks.path_px = shakes.shifts_px;
    return marks;
  }

  SheetRow Row(int64_t clip) const {
    const Config config = config_.Draw(static_cast<uint64_t>(clip), nullptr);
    const int64_t frames = reader_.FrameCount(clip), frame = frames / 2;
    const std::optional<SceneMarks> marks = MarksOf(clip, frame, ShakesOf(clip, config));
    SheetRow row{.label = Label(clip, frame, config, marks),
                 .clean = ForTheEye(reader_.Clean(clip, frame)),
                 .turb = ForTheEye(reader_.Turb(clip, frame)),
                 .tilt = {},
                 .sigma = {},
                 .marks = marks};
    const auto tilt = reader_.TruthTilt(clip, frame), sigma = reader_.TruthSigma(clip, frame);
    if (tilt && sigma) {
      row.tilt = *tilt, row.sigma = *sigma;
    } else if (same_engine_) {  // the fields of another engine would not be those of these pictures
      const sim::ClipPlan plan = PlanOf(config, true);
      if (plan.own_distances) {  // the fields alone don't know where an object scales them
        row.tilt = tilt.value_or(cv::Mat()), row.sigma = sigma.value_or(cv::Mat());
        return row;
      }
      const sim::ClipFields fields(SceneOf(config, true), plan, {config.seed, static_cast<uint64_t>(clip)});
      const sim::FrameTruth truth = fields.Truth(TimeOf(config, frame, frames));
      row.tilt = truth.tilt, row.sigma = truth.sigma;
    }
    return row;
  }

  // Screens show sRGB: linear light would look dark.
  cv::Mat ForTheEye(const dataset::Picture& frame) const {
    return OutputIsLinear(config_.fixed()) ? sim::EncodeSrgb(frame.pixels) : frame.pixels;
  }

  static cv::Mat Small(const cv::Mat& image) {
    const double scale = static_cast<double>(kGifFramePx) / std::max(image.cols, image.rows);
    if (scale >= 1) return image;
    cv::Mat small;
    cv::resize(image, small, Scaled(image.size(), scale), 0, 0, cv::INTER_AREA);
    return small;
  }

  const dataset::DatasetReader& reader_;
  ConfigFile config_;
  bool same_engine_;
};

}  // namespace

cv::Mat ContactSheet(const dataset::DatasetReader& reader, int rows) { return Previewer(reader).Sheet(rows); }

void Preview(const PreviewOptions& options) {
  std::string extension = options.out.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension != ".png" && extension != ".gif")
    throw std::invalid_argument("--out " + options.out.string() +
                                ": must end in .png (contact sheet) or .gif (one clip moving)");
  if (extension == ".png" && options.clip >= 0)
    throw std::invalid_argument(
        "--clip goes with an --out that ends in .gif; a contact sheet shows clips of the whole set");
  const dataset::DatasetReader reader(options.folder);
  if (extension == ".gif")
    dataset::WriteFileAtomically(options.out,
                                 dataset::EncodeGif(Previewer(reader).Frames(options.clip), kGifDelayMs));
  else
    dataset::WriteFileAtomically(options.out, dataset::EncodePng(ContactSheet(reader, options.rows), 8));
}

}  // namespace shimmer::app
