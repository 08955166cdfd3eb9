// Milliseconds per frame of what restores a video, on all threads: at 1080p and the two other sizes of the
// paper's table. stabilise: a frame's shift, and the frame moved by it, as the video goes on (of its first
// frames each is fitted several times). frame: both and filling what the camera did not see.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "restore/background.h"
#include "restore/blend.h"
#include "restore/border_fill.h"
#include "restore/scene_reference.h"
#include "restore/stabilise.h"
#include "restore/translate.h"
#include "restore/turbulence_strength.h"

namespace shimmer::restore {
namespace {

constexpr int kFrames = 12, kFirstFrames = 4;

// 8-bit RGB frames of one scene, off by up to a sixth of the height.
std::vector<cv::Mat> ShakenFrames(cv::Size size) {
  const int most = size.height / 6;
  cv::Mat noise(size.height + 2 * most, size.width + 2 * most, CV_8UC3), scene = noise.clone();
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(noise, scene, {0, 0}, size.height / 200.0);
  cv::normalize(scene, scene, 0, 255, cv::NORM_MINMAX);
  std::vector<cv::Mat> frames;
  for (int k = 0; k < kFrames; ++k) {
    const cv::Point at(random.uniform(0, 2 * most + 1), random.uniform(0, 2 * most + 1));
    cv::Mat frame = scene({at, size}).clone(), own_noise(size, CV_8UC3);
    random.fill(own_noise, cv::RNG::UNIFORM, 0, 8);
    frames.push_back(frame + own_noise);
  }
  return frames;
}

// run(frame, shift) with the clock on, and Next before it if with_search.
template <class Run>
void Frames(benchmark::State& state, cv::Size size, bool with_search, const Run& run) {
  const std::vector<cv::Mat> frames = ShakenFrames(size);
  Stabiliser stabiliser({.first_frames = kFirstFrames});
  for (int k = 0; k < kFirstFrames; ++k) stabiliser.Next(frames[static_cast<size_t>(k)]);
  size_t k = 0;
  int lost = 0;
  for (auto _ : state) {
    const cv::Mat& frame = frames[k++ % kFrames];
    FrameShift shift{.px = {17.3 + 0.1 * static_cast<double>(k % 8), -9.6}};
    if (with_search) {
      const FrameShift found = stabiliser.Next(frame).front();
      lost += found.match != Match::kFound;
    }
    run(frame, shift);
  }
  if (lost > 0) state.SkipWithError("frames were lost");
}

void Shift(benchmark::State& state, cv::Size size) {
  Frames(state, size, true, [](const cv::Mat&, const FrameShift&) {});
}

void Move(benchmark::State& state, cv::Size size) {
  Frames(state, size, false, [](const cv::Mat& frame, const FrameShift& shift) {
    benchmark::DoNotOptimize(Translated(frame, shift.px).data);
  });
}

void Stabilise(benchmark::State& state, cv::Size size) {
  Frames(state, size, true, [](const cv::Mat& frame, const FrameShift& shift) {
    benchmark::DoNotOptimize(Translated(frame, shift.px).data);
  });
}

void StabiliseAndFill(benchmark::State& state, cv::Size size) {
  BorderFill fill;
  Frames(state, size, true, [&](const cv::Mat& frame, const FrameShift& shift) {
    benchmark::DoNotOptimize(fill.Next(frame, shift));
  });
}

// All of a clip of the default number of first frames; items are frames.
void FirstFrames(benchmark::State& state, cv::Size size) {
  const std::vector<cv::Mat> frames = ShakenFrames(size);
  const int count = StabiliseParams{}.first_frames;
  for (auto _ : state) {
    Stabiliser stabiliser;
    for (int k = 0; k < count; ++k)
      benchmark::DoNotOptimize(stabiliser.Next(frames[static_cast<size_t>(k) % kFrames]));
  }
  state.SetItemsProcessed(state.iterations() * count);
}

// A scene in air that moves it by a px or so, and what moves in it.
struct Turbulent {
  std::vector<cv::Mat> frames, moving;
};

Turbulent TurbulentFrames(cv::Size size) {
  const cv::Mat scene = ShakenFrames(size).front();
  Turbulent video;
  cv::RNG random(2);
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat map(size, CV_32FC2), tilt(size / 8, CV_32FC2), frame;
    random.fill(tilt, cv::RNG::NORMAL, 0, 2);
    cv::resize(tilt, map, size, 0, 0, cv::INTER_CUBIC);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) map.at<cv::Vec2f>(y, x) += cv::Vec2f(x, y);
    cv::remap(scene, frame, map, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::Mat moving = cv::Mat::zeros(size, CV_8UC1);
    const cv::Point at(size.width * (k + 2) / (kFrames + 4), size.height / 2);
    cv::ellipse(frame, at, size / 7, 0, 0, 360, {200, 40, 60}, cv::FILLED);
    cv::ellipse(moving, at, size / 7, 0, 0, 360, 255, cv::FILLED);
    cv::GaussianBlur(moving, moving, {0, 0}, 2);
    video.frames.push_back(frame);
    video.moving.push_back(moving);
  }
  return video;
}

void MeanBackground(benchmark::State& state, cv::Size size, bool registered) {
  const Turbulent video = TurbulentFrames(size);
  BackgroundParams params{.registered = registered};
  if (registered) {
    SceneReferenceMean mean;
    for (size_t k = 0; k < kFrames; ++k) mean.Add({video.frames[k], ~video.moving[k]});
    params.scene = mean.Result();
  }
  Background background(params);
  size_t k = 0;
  const auto next = [&] {
    const size_t at = k++ % kFrames;
    return background.Next({video.frames[at], {}}, video.moving[at]);
  };
  while (k < 30) next();  // the window is full
  for (auto _ : state) benchmark::DoNotOptimize(next());
}

void PlainBackground(benchmark::State& state, cv::Size size) { MeanBackground(state, size, false); }
void RegisteredBackground(benchmark::State& state, cv::Size size) { MeanBackground(state, size, true); }

void Strength(benchmark::State& state, cv::Size size) {
  const Turbulent video = TurbulentFrames(size);
  StrengthEstimate estimate;
  size_t k = 0;
  for (auto _ : state) {
    const size_t at = k++ % kFrames;
    estimate.Add(video.frames[at], video.moving[at]);
  }
}

void Reference(benchmark::State& state, cv::Size size) {
  const Turbulent video = TurbulentFrames(size);
  SceneReferenceMean mean;
  for (size_t k = 0; k < 32; ++k) mean.Add({video.frames[k % kFrames], ~video.moving[k % kFrames]});
  for (auto _ : state) benchmark::DoNotOptimize(mean.Result().grey.data);
}

void Blend(benchmark::State& state, cv::Size size) {
  const Turbulent video = TurbulentFrames(size);
  size_t k = 0;
  for (auto _ : state) {
    const size_t at = k++ % kFrames;
    benchmark::DoNotOptimize(
        Blended(video.frames[at], video.frames[(at + 5) % kFrames], video.moving[at]).data);
  }
}

}  // namespace
}  // namespace shimmer::restore

int main(int argc, char** argv) {
  using namespace shimmer::restore;
  using benchmark::State;
  for (const cv::Size size : {cv::Size(1920, 1080), cv::Size(960, 540), cv::Size(480, 270)}) {
    const std::string at = "/" + std::to_string(size.width) + "x" + std::to_string(size.height);
    const auto add = [&](const std::string& name, void (*run)(State&, cv::Size)) {
      benchmark::RegisterBenchmark((name + at).c_str(), [=](State& s) { run(s, size); })
          ->Unit(benchmark::kMillisecond)
          ->MeasureProcessCPUTime()
          ->UseRealTime();
    };
    add("stabilise, shift", Shift);
    add("stabilise, move", Move);
    add("stabilise", Stabilise);
    add("stabilise and fill", StabiliseAndFill);
    add("stabilise, first frames", FirstFrames);
    add("strength", Strength);
    add("background", PlainBackground);
    add("background, registered", RegisteredBackground);
    add("reference of 32 places", Reference);
    add("blend", Blend);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
