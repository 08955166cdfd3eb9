#include "tests/bench/step_case.h"

#include <tbb/global_control.h>

namespace shimmer::bench {

StepResult RunStep(const StepCase& step_case, const Patience& patience,
                   const std::function<cv::Mat(int)>& clean) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(step_case.threads));
  const sim::ClipShape shape{.size = step_case.size, .frames = 1000};
  const cv::Mat frame = clean(Step(step_case.scene, shape, {}).halo_px());
  cv::Mat turb(step_case.size, frame.type(), cv::Scalar::all(1));

  const PeakMemory memory;
  std::optional<Step> step;
  const Timing setup = Measure({.seconds = 0, .least_blocks = 1}, [&](int) {
    step.emplace(step_case.scene, shape, sim::Accuracy{});
    step->Prepare(frame);
  });
  StepResult result;
  result.setup_ms = setup.wall_ms;
  result.time = Measure(patience, [&](int t) {
    if (!step_case.scene.still) step->Prepare(frame);
    step->Render(t, turb);
  });
  result.peak_bytes = memory.Bytes();
  return result;
}

sim::Scene StandardScene(bool still) {
  sim::Scene scene;
  scene.tilt.strength_px = 5;
  scene.tilt.base_frequency = scene.blur.base_frequency = 1 / 64.0;
  scene.blur.max_sigma_px = 8;
  scene.still = still;
  return scene;
}

sim::Scene ExampleScene(uint64_t i) {
  const sim::ClipKey key{.seed = kBenchClip.seed, .clip = i};
  sim::Scene scene;
  scene.tilt.strength_px = sim::DrawUniform(key, "tilt.strength_px", 1, 10);
  scene.tilt.base_frequency = sim::DrawUniform(key, "tilt.base_frequency", 0.015, 0.06);
  scene.tilt.temporal_scale = sim::DrawUniform(key, "tilt.temporal_scale", 0.5, 4);
  scene.blur.max_sigma_px = sim::DrawUniform(key, "blur.max_sigma_px", 0.5, 6);
  scene.blur.base_frequency = 0.015;
  return scene;
}

}  // namespace shimmer::bench
