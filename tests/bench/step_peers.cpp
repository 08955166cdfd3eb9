#include "sim/gaussian.h"
#include "sim/warp.h"
#include "tests/bench/authors_method.h"
#include "tests/bench/double_pipeline.h"
#include "tests/bench/opencv_method.h"
#include "tests/bench/step_sections.h"

namespace shimmer::bench {
namespace {

constexpr int kFrames = 2;  // of the authors' clip: mirroring needs more than one

double AuthorsMs(AuthorsMode mode, const Patience& patience, const cv::Mat& clean) {
  const AuthorsMethod authors(StandardScene(true), clean.size(), kFrames, mode);
  return Measure(patience, [&](int) { authors.RenderClip(clean); }).cpu_ms / kFrames;
}

// Without the fields, which are given.
double OpenCvMs(const Patience& patience, const CleanPicture& picture, cv::Size size) {
  const sim::Scene scene = StandardScene(true);
  const int border_px = sim::GaussianRadius(scene.blur.max_sigma_px),
            margin_px = static_cast<int>(scene.tilt.BoundPx()) + sim::kWarpReachPx;
  const ExactShifts shifts = ExactTilt(sim::TiltField(scene.tilt, kBenchClip), size, border_px, 0);
  const cv::Mat sigma =
      ExactSigma(scene, sim::BlurNoise(scene.blur, scene.tilt.lattice, kBenchClip), shifts, border_px, 0);
  cv::Mat dx, dy;
  shifts.dx.convertTo(dx, CV_32F);
  shifts.dy.convertTo(dy, CV_32F);
  const cv::Mat clean = picture.Bytes(border_px + margin_px);
  return Measure(patience,
                 [&](int) {
                   OpenCvBlur(OpenCvWarp(clean, margin_px, dx, dy), border_px, sigma,
                              scene.blur.max_sigma_px);
                 })
      .cpu_ms;
}

}  // namespace

Json PeersSection(const StepOptions& options) {
  std::printf(
      "Beside others, one core: the method of the paper's authors, built here, and their own program, "
      "quoted;\n"
      "OpenCV's way, its fields not counted\n");
  Table table({"", "ms", "frames/s", "times ours", "program ms", "times ours"});
  Json json = Json::array();
  const Patience patience = options.quick ? options.patience() : Patience{2, 3, 9, 1};
  for (const int side : {512, 200}) {
    const cv::Size size = options.quick ? cv::Size(side / 8, side / 8) : cv::Size(side, side);
    const CleanPicture picture(options.picture, size);
    const StepResult ours = Run({StandardScene(true), size, 1}, options, picture);
    const double our_ms = ours.time.cpu_ms;
    Json record{{"width", size.width}, {"height", size.height}, {"shimmer", Record(ours)}};
    table.Add({SizeText(size) + " Shimmer", Number(our_ms, 2), Number(1000 / our_ms, 1), "1", "", ""});
    for (const AuthorsMode mode : {AuthorsMode::kFast, AuthorsMode::kFull}) {
      const bool fast = mode == AuthorsMode::kFast;
      const double ms = AuthorsMs(mode, patience, picture.Bytes(0));
      const double quoted_ms = side == 512 ? (fast ? kAuthorsFastMs512 : kAuthorsFullMs512)
                                           : 1000 / (fast ? kAuthorsFastFps200 : kAuthorsFullFps200);
      table.Add({SizeText(size) + (fast ? " authors' method, fast" : " authors' method, full"), Number(ms, 1),
                 Number(1000 / ms, 1), Number(ms / our_ms, 1), Number(quoted_ms, 0),
                 Number(quoted_ms / our_ms, 1)});
      record[fast ? "authors_fast" : "authors_full"] = {{"cpu_ms", ms},
                                                        {"times_ours", ms / our_ms},
                                                        {"program_ms", quoted_ms},
                                                        {"program_times_ours", quoted_ms / our_ms}};
    }
    const double opencv_ms = OpenCvMs(patience, picture, size);
    table.Add({SizeText(size) + " OpenCV's way", Number(opencv_ms, 1), Number(1000 / opencv_ms, 1),
               Number(opencv_ms / our_ms, 1), "", ""});
    record["opencv"] = {{"cpu_ms", opencv_ms}, {"times_ours", opencv_ms / our_ms}};
    json.push_back(record);
  }
  table.Print();
  return json;
}

}  // namespace shimmer::bench
