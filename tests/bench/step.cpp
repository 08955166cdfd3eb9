#include "tests/bench/step.h"

namespace shimmer::bench {

Step::Step(const sim::Scene& scene, const sim::ClipShape& shape, const sim::Accuracy& accuracy)
    : plan_(sim::PlanClip(scene, shape, accuracy)), renderer_(scene, plan_, kBenchClip) {}

void Step::Prepare(const cv::Mat& clean) { clean_.emplace(renderer_.Prepare(clean)); }

void Step::Render(int64_t t, cv::Mat& turb) {
  frame_.turb = turb;
  renderer_.Render(t, *clean_, false, frame_);
  turb = frame_.turb;
}

}  // namespace shimmer::bench
