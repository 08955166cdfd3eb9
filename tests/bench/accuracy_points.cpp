#include "tests/bench/accuracy_points.h"

#include <tbb/global_control.h>

#include <cmath>

#include "sim/gaussian.h"
#include "sim/warp.h"
#include "tests/bench/authors_method.h"
#include "tests/bench/opencv_method.h"
#include "tests/bench/step.h"

namespace shimmer::bench {
namespace {

constexpr int kFrame = 5;          // whose error is measured
constexpr int kFieldFrames = 3;    // of fields, from kFrame on: they may be interpolated along time
constexpr int kAuthorsFrames = 2;  // of their clip: mirroring needs more than one
constexpr double kLevels = 255;

ExactShifts AsDouble(const cv::Mat& dx, const cv::Mat& dy) {
  ExactShifts shifts;
  dx.convertTo(shifts.dx, CV_64F);
  dy.convertTo(shifts.dy, CV_64F);
  return shifts;
}

cv::Mat Merged(const cv::Mat& dx, const cv::Mat& dy) {
  cv::Mat both;
  cv::merge(std::vector{dx, dy}, both);
  return both;
}

cv::Mat Padded(const cv::Mat& frame, int margin_px) {
  cv::Mat padded;
  cv::copyMakeBorder(frame, padded, margin_px, margin_px, margin_px, margin_px, cv::BORDER_REPLICATE);
  return padded;
}

class SceneMeter {
 public:
  SceneMeter(const AccuracyScene& scene, const AccuracySetup& setup, const CleanPicture& picture)
      : name_(scene.name),
        scene_(scene.scene),
        setup_(setup),
        picture_(picture),
        field_(scene_.tilt, kBenchClip),
        border_px_(sim::GaussianRadius(scene_.blur.max_sigma_px)),
        shifts_(ExactTilt(field_, setup.size, border_px_, kFrame)) {
    const sim::BlurNoise noise(scene_.blur, scene_.tilt.lattice, kBenchClip);
    sigma_ = ExactSigma(scene_, noise, shifts_, border_px_, kFrame);
    for (int t = kFrame; t < kFrame + kFieldFrames; ++t) {
      const ExactShifts shifts = ExactTilt(field_, setup.size, 0, t);
      exact_fields_.push_back(Merged(shifts.dx, shifts.dy));
      faces_.push_back(OnFaces(field_, setup.size, t));
    }
  }

  std::vector<AccuracyPoint> All() {
    for (const double px : setup_.budgets_px) Fields({.max_error_px = px});
    for (const double px : setup_.budgets_px) Warp({.max_error_px = px});
    for (const double levels : setup_.budgets_levels) Blur({.max_error_levels = levels});

    const cv::Mat exact = ExactFrame(CatmullRom);
    for (const double px : setup_.budgets_px) Frame(Sweep::kPx, {.max_error_px = px}, exact);
    for (const double levels : setup_.budgets_levels)
      Frame(Sweep::kLevels, {.max_error_levels = levels}, exact);
    const double px_per_level = sim::Accuracy{}.max_error_px / sim::Accuracy{}.max_error_levels;
    for (const double levels : setup_.budgets_levels)
      Frame(Sweep::kBoth, {.max_error_px = levels * px_per_level, .max_error_levels = levels}, exact);
    Authors();
    OpenCv();
    return points_;
  }

 private:
  // In ns a pixel, of one thread.
  double Time(const std::function<void(int)>& run) const {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    return 1e6 * Measure(setup_.patience, run).cpu_ms / setup_.size.area();
  }

  void Add(Part part, Method method, double ns_per_pixel, Error error, Sweep sweep = Sweep::kBoth,
           const sim::Accuracy& budget = {}) {
    if (part != Part::kFields) error = {error.rms * kLevels, error.max * kLevels};
    points_.push_back({part, method, name_, sweep, budget, ns_per_pixel, error});
  }

  Step StepOf(const sim::Scene& scene, const sim::Accuracy& budget) const {
    return Step(scene, {.size = setup_.size, .frames = 1000}, budget);
  }
  double TimeFrames(Step& step) const {
    const cv::Mat clean = picture_.Bytes(step.halo_px());
    cv::Mat turb;
    step.Prepare(clean);
    return Time([&](int t) { step.Render(t, turb); });
  }
  cv::Mat FloatFrame(Step& step) const {
    const cv::Mat clean = picture_.Floats(step.halo_px());
    cv::Mat turb;
    step.Prepare(clean);
    step.Render(kFrame, turb);
    return turb;
  }

  void Fields(const sim::Accuracy& budget) {
    sim::Scene scene = scene_;
    scene.blur.max_sigma_px = 0;
    const Step step = StepOf(scene, budget);
    cv::Mat fields;
    for (int t = kFrame; t < kFrame + kFieldFrames; ++t) fields.push_back(step.Fields(t).tilt);
    Add(Part::kFields, Method::kShimmer, Time([&](int t) { step.Fields(t); }),
        ErrorOf(fields, exact_fields_, faces_), Sweep::kPx, budget);
  }

  // Frozen and without a blur: what is left on the clock is the warp.
  void Warp(const sim::Accuracy& budget) {
    sim::Scene scene = scene_;
    scene.still = false;
    scene.blur.max_sigma_px = 0;
    scene.tilt.temporal_scale = 0;
    Step step = StepOf(scene, budget);
    cv::Mat axes[2];
    cv::split(step.Fields(kFrame).tilt, axes);
    const cv::Mat exact =
        ExactWarp(picture_.Floats(step.halo_px()), step.halo_px(), AsDouble(axes[0], axes[1]), CatmullRom);
    const Error error = ErrorOf(FloatFrame(step), exact);
    Add(Part::kWarp, Method::kShimmer, TimeFrames(step), error, Sweep::kPx, budget);
  }

  // A frozen map without a tilt: what is left on the clock is the blur.
  void Blur(const sim::Accuracy& budget) {
    sim::Scene scene = scene_;
    scene.still = false;
    scene.tilt.strength_px = 0;
    scene.blur.tilt_weight = 0;
    scene.blur.temporal_scale = 0;
    Step step = StepOf(scene, budget);
    const cv::Mat exact = ExactBlur(picture_.Floats(border_px_), border_px_, step.Fields(kFrame).sigma);
    const Error error = ErrorOf(FloatFrame(step), exact);
    Add(Part::kBlur, Method::kShimmer, TimeFrames(step), error, Sweep::kLevels, budget);
  }

  cv::Mat ExactFrame(const ReadPlane& read) const {
    const int margin_px = static_cast<int>(std::ceil(scene_.tilt.BoundPx())) + sim::kWarpReachPx;
    const cv::Mat clean = picture_.Floats(border_px_ + margin_px);
    return ExactBlur(ExactWarp(clean, margin_px, shifts_, read), border_px_, sigma_);
  }

  void Frame(Sweep sweep, const sim::Accuracy& budget, const cv::Mat& exact) {
    Step step = StepOf(scene_, budget);
    const Error error = ErrorOf(FloatFrame(step), exact, faces_.rowRange(0, setup_.size.height));
    Add(Part::kFrame, Method::kShimmer, TimeFrames(step), error, sweep, budget);
  }

  // Each of their parts against the same part in double, as they mean it.
  void Authors() {
    const AuthorsMethod authors(scene_, setup_.size, kAuthorsFrames, AuthorsMode::kFast);
    const cv::Mat bytes = picture_.Bytes(0), floats = picture_.Floats(0);
    const int margin_px = static_cast<int>(std::ceil(scene_.tilt.BoundPx())) + sim::kWarpReachPx;
    const AuthorsMethod::Shifts shifts = authors.ClipShifts()[0], true_shifts = authors.ExactShifts(0);
    const cv::Mat sigma = authors.SigmaMap(0);
    const auto exact_warp = [&](const AuthorsMethod::Shifts& by) {
      return ExactWarp(Padded(floats, margin_px), margin_px, AsDouble(by.dx, by.dy), CatmullRom);
    };
    const auto exact_blur = [&](const cv::Mat& frame, const cv::Mat& by) {
      return ExactBlur(Padded(frame, border_px_), border_px_, by);
    };

    Add(Part::kFields, Method::kAuthors, Time([&](int) { authors.ClipShifts(); }) / kAuthorsFrames,
        ErrorOf(Merged(shifts.dx, shifts.dy), Merged(true_shifts.dx, true_shifts.dy)));
    Add(Part::kWarp, Method::kAuthors, Time([&](int) { authors.Warp(bytes, shifts); }),
        ErrorOf(authors.Warp(floats, shifts), exact_warp(shifts)));
    Add(Part::kBlur, Method::kAuthors, Time([&](int) { authors.Blur(bytes, sigma); }),
        ErrorOf(authors.Blur(floats, sigma), exact_blur(floats, sigma)));
    Add(Part::kFrame, Method::kAuthors, Time([&](int) { authors.RenderClip(bytes); }) / kAuthorsFrames,
        ErrorOf(authors.RenderClip(floats)[0],
                exact_blur(exact_warp(true_shifts), authors.ExactSigmaMap(0))));
  }

  // Shifts and sigmas are ours, in double, and cost nothing.
  void OpenCv() {
    const int margin_px = static_cast<int>(std::ceil(scene_.tilt.BoundPx())) + sim::kWarpReachPx;
    const cv::Mat bytes = picture_.Bytes(border_px_ + margin_px),
                  floats = picture_.Floats(border_px_ + margin_px);
    cv::Mat dx, dy;
    shifts_.dx.convertTo(dx, CV_32F);
    shifts_.dy.convertTo(dy, CV_32F);
    const auto warp = [&](const cv::Mat& clean) { return OpenCvWarp(clean, margin_px, dx, dy); };
    const auto blur = [&](const cv::Mat& frame) {
      return OpenCvBlur(frame, border_px_, sigma_, scene_.blur.max_sigma_px);
    };
    const cv::Mat border_bytes = picture_.Bytes(border_px_), border_floats = picture_.Floats(border_px_);

    const double border_share = static_cast<double>(setup_.size.area()) / dx.size().area();
    Add(Part::kWarp, Method::kOpenCv, border_share * Time([&](int) { warp(bytes); }),
        ErrorOf(warp(floats), ExactWarp(floats, margin_px, shifts_, OpenCvCubicDouble)));
    Add(Part::kBlur, Method::kOpenCv, Time([&](int) { blur(border_bytes); }),
        ErrorOf(blur(border_floats), ExactBlur(border_floats, border_px_, sigma_)));
    Add(Part::kFrame, Method::kOpenCv, Time([&](int) { blur(warp(bytes)); }),
        ErrorOf(blur(warp(floats)), ExactFrame(OpenCvCubicDouble)));
  }

  const std::string name_;
  const sim::Scene scene_;
  const AccuracySetup& setup_;
  const CleanPicture& picture_;
  const sim::TiltField field_;
  const int border_px_;
  const ExactShifts shifts_;  // of kFrame, with the border
  cv::Mat sigma_;             // of kFrame
  cv::Mat exact_fields_;      // of the field frames, one below the other: CV_64FC2
  cv::Mat faces_;             // the same: where both sides of a jump are right
  std::vector<AccuracyPoint> points_;
};

}  // namespace

std::vector<AccuracyScene> AccuracyScenes() {
  const auto scene = [](std::string name, double strength_px, double max_sigma_px) {
    AccuracyScene result{std::move(name), {}};
    result.scene.tilt.strength_px = strength_px;
    result.scene.blur.max_sigma_px = max_sigma_px;
    return result;
  };
  return {scene("weak", 2, 1.5), scene("medium", 4, 3), scene("strong", 8, 6)};
}

std::vector<AccuracyPoint> MeasureAccuracy(const AccuracyScene& scene, const AccuracySetup& setup,
                                           const CleanPicture& picture) {
  return SceneMeter(scene, setup, picture).All();
}

}  // namespace shimmer::bench
