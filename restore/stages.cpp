#include "restore/stages.h"

#include <deque>
#include <utility>

#include "restore/border_fill.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

class OneChannel : public Stage {
 public:
  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    if (frame.frame.channels() > 1) cv::extractChannel(cv::Mat(frame.frame), frame.frame, 0);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }
};

// Moved to where the first frame's camera saw it, and cut to what all frames see.
class Crop : public Stage {
 public:
  Crop(const RestorePlan& plan, const VideoFacts& facts) : area_(plan.area), shifts_(facts.shifts) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    const cv::Point2d shift_px = shifts_[static_cast<size_t>(frame.index)].px;
    frame.frame = Translated(frame.frame, shift_px)(area_);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }

 private:
  cv::Rect area_;
  const std::vector<FrameShift>& shifts_;
};

// The same, and what it does not see filled from its neighbours.
class Fill : public Stage {
 public:
  explicit Fill(const VideoFacts& facts) : shifts_(facts.shifts) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    std::vector<FrameOnWay> done;
    Add(fill_.Next(frame.frame, shifts_[static_cast<size_t>(frame.index)]), done);
    return done;
  }

  std::vector<FrameOnWay> Rest() override {
    std::vector<FrameOnWay> done;
    while (Add(fill_.Rest(), done)) {
    }
    return done;
  }

 private:
  bool Add(std::optional<SteadyFrame> steady, std::vector<FrameOnWay>& done) {
    if (!steady) return false;
    done.push_back({.index = given_++, .frame = steady->frame, .steady = {}, .own = steady->own});
    return true;
  }

  const std::vector<FrameShift>& shifts_;
  BorderFill fill_;
  int64_t given_ = 0;
};

// What comes out of stabilising, kept beside what the stages after it make of it.
class Keep : public Stage {
 public:
  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    frame.steady = frame.frame;
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }
};

}  // namespace

std::vector<std::unique_ptr<Stage>> StagesOf(const RestorePlan& plan, const VideoFacts& facts) {
  std::vector<std::unique_ptr<Stage>> stages;
  if (plan.grey) stages.push_back(std::make_unique<OneChannel>());
  if (plan.fill)
    stages.push_back(std::make_unique<Fill>(facts));
  else if (plan.stabilise)
    stages.push_back(std::make_unique<Crop>(plan, facts));
  stages.push_back(std::make_unique<Keep>());
  return stages;
}

}  // namespace shimmer::restore
