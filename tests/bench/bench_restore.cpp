// Milliseconds per frame of what restores a video, on all threads: at 1080p and the two other sizes of the
// paper's table. stabilise: a frame's shift, and the frame moved by it, as the video goes on (of its first
// frames each is fitted several times). frame: both and filling what the camera did not see.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "restore/border_fill.h"
#include "restore/stabilise.h"
#include "restore/translate.h"

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
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
