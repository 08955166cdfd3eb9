#include "sim/clip.h"

#include "sim/size_text.h"

#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace shimmer::sim {

// As many as frames were ever made at once.
class ClipRenderer::MemoryPool {
 public:
  std::unique_ptr<FrameMemory> Take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<FrameMemory>();
    std::unique_ptr<FrameMemory> memory = std::move(free_.back());
    free_.pop_back();
    return memory;
  }
  void GiveBack(std::unique_ptr<FrameMemory> memory) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameMemory>> free_;
};

ClipRenderer::ClipRenderer(const Scene& scene, const ClipPlan& plan, ClipKey key)
    : scene_(scene), plan_(plan), fields_(scene, plan, key), pool_(std::make_unique<MemoryPool>()) {}

ClipRenderer::~ClipRenderer() = default;

CleanFrame ClipRenderer::Prepare(const cv::Mat& samples) const {
  const int around_px = 2 * plan_.AroundPx();
  const cv::Size size = samples.size(),
                 wanted(plan_.shape.size.width + around_px, plan_.shape.size.height + around_px);
  if (size != wanted)
    throw std::invalid_argument("clean frame of " + SizeText(size) + " px, must be " + SizeText(wanted));
  return {samples, {-plan_.AroundPx(), -plan_.AroundPx()}, plan_};
}

void ClipRenderer::Render(int64_t t, const CleanFrame& clean, bool with_truth, RenderedFrame& frame,
                          const FrameView& view) const {
  const cv::Rect window = plan_.Window(view.shake_px);
  if ((window & cv::Rect(clean.origin, clean.samples.size())) != window)
    throw std::invalid_argument("clean frame: does not hold all that is read for a shake of (" +
                                NumberText(view.shake_px.x) + ", " + NumberText(view.shake_px.y) + ") px");
  std::unique_ptr<FrameMemory> memory = pool_->Take();
  RenderFrame(scene_, plan_, fields_, t, clean, view, with_truth, *memory, frame);
  pool_->GiveBack(std::move(memory));
}

RenderedFrame ClipRenderer::Render(int64_t t, const cv::Mat& samples) const {
  RenderedFrame frame;
  Render(t, Prepare(samples), true, frame);
  return frame;
}

}  // namespace shimmer::sim
