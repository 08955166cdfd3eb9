// Frames of one clip from many threads at once: what ThreadSanitizer looks at (scripts/sanitize.sh).
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "sim/clip.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

std::vector<cv::Mat> Frames(const ClipRenderer& renderer, const CleanFrame& clean, int frames, int threads) {
  std::vector<RenderedFrame> rendered(static_cast<size_t>(frames));
  {
    std::vector<std::jthread> workers;
    for (int worker = 0; worker < threads; ++worker)
      workers.emplace_back([&, worker] {
        for (int t = worker; t < frames; t += threads)
          renderer.Render(t, clean, t % 2 == 0, rendered[static_cast<size_t>(t)]);
      });
  }
  std::vector<cv::Mat> turb;
  for (const RenderedFrame& frame : rendered) turb.push_back(frame.turb);
  return turb;
}

TEST(ThreadsStress, FramesOfAClipFromManyThreads) {
  for (const BlurMethod method : {BlurMethod::kAuto, BlurMethod::kExact, BlurMethod::kStack})
    for (const double temporal_scale : {0.0, 0.02, 3.0}) {  // frozen; slow, on key frames that are kept; fast
      Scene scene;
      scene.tilt.temporal_scale = scene.blur.temporal_scale = temporal_scale;
      scene.tilt.kernel = 0.5;
      scene.blur.method = method;
      const ClipPlan plan = PlanClip(scene, {.size = {120, 90}, .frames = 12}, {.max_error_px = 0.3});
      const cv::Mat samples = SinesPicture({120, 90}, plan.halo_px);
      const ClipRenderer together(scene, plan, {0, 0}), alone(scene, plan, {0, 0});
      const std::vector<cv::Mat> many = Frames(together, together.Prepare(samples), 12, 4),
                                 one = Frames(alone, alone.Prepare(samples), 12, 1);
      for (size_t t = 0; t < many.size(); ++t) EXPECT_TRUE(SameBytes(many[t], one[t])) << t;
    }
}

}  // namespace
}  // namespace shimmer::sim
