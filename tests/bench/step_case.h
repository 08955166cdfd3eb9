// One measurement of the whole step: a scene, a frame, a number of threads.
#pragma once

#include "tests/bench/measure.h"
#include "tests/bench/step.h"

namespace shimmer::bench {

struct StepCase {
  sim::Scene scene;  // scene.still: prepared once; else each frame anew, on the clock
  cv::Size size;
  int threads = 1;
};

struct StepResult {
  Timing time;             // of a frame, memory to memory
  double setup_ms = 0;     // plan, renderer and, of a still, its preparation: once a clip
  int64_t peak_bytes = 0;  // of all that the step allocates; clean and turbulent frame aside
};

// clean(halo_px) is the clean frame with that halo.
StepResult RunStep(const StepCase& step_case, const Patience& patience,
                   const std::function<cv::Mat(int)>& clean);

// The step that all figures are about: 8 octaves of tilt, 11 of sigma, f = 1/64 for both, S = 5, sigma 0 to
// 8 px.
sim::Scene StandardScene(bool still);

// Clip i of a training set as people generate it: tilt.strength_px in [1, 10], tilt.base_frequency in
// [0.015, 0.06], tilt.temporal_scale in [0.5, 4], blur.max_sigma_px in [0.5, 6], all uniform.
sim::Scene ExampleScene(uint64_t i);

}  // namespace shimmer::bench
