#include "restore/pipeline.h"

#include <tbb/parallel_pipeline.h>

#include <chrono>
#include <utility>

namespace shimmer::restore {
namespace {

using Clock = std::chrono::steady_clock;

// What goes from stage to stage: frames that became ready together, none or many.
struct Batch {
  std::vector<FrameOnWay> frames = {};
  bool last = false;
};

Batch Through(Stage& stage, Batch batch) {
  Batch done{.last = batch.last};
  const auto take = [&](std::vector<FrameOnWay> frames) {
    std::move(frames.begin(), frames.end(), std::back_inserter(done.frames));
  };
  for (FrameOnWay& frame : batch.frames) take(stage.Next(std::move(frame)));
  if (batch.last) take(stage.Rest());
  return done;
}

}  // namespace

void Restore(Frames& video, const VideoFacts& facts, const RestorePlan& plan, Sharpener* sharpener,
             const std::function<void(const FrameOnWay&)>& sink, StageTimes* times) {
  const size_t batches_at_once = times ? 1 : 4;
  constexpr auto kInOrder = tbb::filter_mode::serial_in_order;
  const std::vector<NamedStage> stages = StagesOf(plan, facts, sharpener);
  int64_t next = 0;
  auto way = tbb::make_filter<void, Batch>(kInOrder, [&](tbb::flow_control& control) -> Batch {
    if (next == facts.frames) {
      control.stop();
      return {};
    }
    const int64_t k = next++;
    return {.frames = {{.index = k, .frame = video.Read(k), .steady = {}, .own = {}}},
            .last = next == facts.frames};
  });
  for (const NamedStage& named : stages)
    way &= tbb::make_filter<Batch, Batch>(kInOrder, [&named, times](Batch batch) {
      const auto start = Clock::now();
      Batch done = Through(*named.stage, std::move(batch));
      if (times) (*times)[named.name] += std::chrono::duration<double>(Clock::now() - start).count();
      return done;
    });
  tbb::parallel_pipeline(batches_at_once,
                         way & tbb::make_filter<Batch, void>(kInOrder, [&](const Batch& batch) {
                           for (const FrameOnWay& frame : batch.frames) sink(frame);
                         }));
}

}  // namespace shimmer::restore
