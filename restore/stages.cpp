#include "restore/stages.h"

#include <deque>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "restore/background.h"
#include "restore/blend.h"
#include "restore/border_fill.h"
#include "restore/levels.h"
#include "restore/segment.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

cv::Mat OwnOf(const FrameOnWay& frame) {
  return frame.own.empty() ? cv::Mat(frame.frame.size(), CV_8UC1, cv::Scalar(255)) : frame.own;
}

class OneChannel : public Stage {
 public:
  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    if (frame.frame.channels() > 1) cv::extractChannel(cv::Mat(frame.frame), frame.frame, 0);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }
};

// Moved to where the first frame's camera saw it.
class Move : public Stage {
 public:
  explicit Move(const VideoFacts& facts) : shifts_(facts.shifts) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    const cv::Point2d shift_px = shifts_[static_cast<size_t>(frame.index)].px;
    frame.frame = Translated(frame.frame, shift_px);
    frame.own = cv::Mat::zeros(frame.frame.size(), CV_8UC1);
    frame.own(SeenArea(frame.frame.size(), shift_px)).setTo(255);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }

 private:
  const std::vector<FrameShift>& shifts_;
};

// Cut to what all frames see, once only px by themselves are left to be made better: the stages before work
// on frames of one size.
class Cut : public Stage {
 public:
  explicit Cut(cv::Rect area) : area_(area) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    for (cv::Mat* picture : {&frame.frame, &frame.steady, &frame.own, &frame.mask, &frame.background})
      if (!picture->empty()) *picture = (*picture)(area_);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }

 private:
  cv::Rect area_;
};

// The bars that never change around it again, as they are in the first frame.
class PutBack : public Stage {
 public:
  PutBack(const cv::Mat& first, cv::Rect picture) : first_(first), picture_(picture) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    cv::Mat whole;
    if (frame.frame.channels() < first_.channels())
      cv::extractChannel(first_, whole, 0);
    else
      whole = first_.clone();
    frame.frame.copyTo(whole(picture_));
    frame.frame = whole;
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }

 private:
  cv::Mat first_;
  cv::Rect picture_;
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

// Frames that wait for what a stage finds out about them, which comes in their order.
class Waiting {
 public:
  void Add(FrameOnWay frame) { frames_.push_back(std::move(frame)); }

  FrameOnWay Take() {
    FrameOnWay frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }

 private:
  std::deque<FrameOnWay> frames_;
};

class Segment : public Stage {
 public:
  explicit Segment(const SegmentSettings& settings) : segmenter_(settings) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    waiting_.Add(frame);
    return WithMask(segmenter_.Next({frame.frame, OwnOf(frame)}));
  }
  std::vector<FrameOnWay> Rest() override {
    std::vector<FrameOnWay> done;
    while (auto mask = segmenter_.Rest()) done.push_back(WithMask(std::move(mask)).front());
    return done;
  }

 private:
  std::vector<FrameOnWay> WithMask(std::optional<cv::Mat> mask) {
    if (!mask) return {};
    FrameOnWay frame = waiting_.Take();
    frame.mask = *mask;
    return {frame};
  }

  Segmenter segmenter_;
  Waiting waiting_;
};

// The still scene that the look at the video has found, as a frame of that size and type. Empty where it
// found none (kAof).
cv::Mat PictureOf(const StillScene& scene, cv::Size size, int type) {
  if (scene.picture.empty()) return {};
  cv::Mat large, picture;
  cv::resize(scene.picture, large, size, 0, 0, cv::INTER_LINEAR);
  large.convertTo(picture, CV_MAT_DEPTH(type), WhiteOf(CV_MAT_DEPTH(type)) / 255);
  return picture;
}

// scene: what lies behind a px that is hidden from the first frame on.
class Stack : public Stage {
 public:
  Stack(const BackgroundParams& params, const StillScene& scene) : background_(params), scene_(scene) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    if (frame.index == 0)
      if (const cv::Mat picture = PictureOf(scene_, frame.frame.size(), frame.frame.type()); !picture.empty())
        background_.StartFrom(picture);
    waiting_.Add(frame);
    std::vector<FrameOnWay> done;
    for (const BackgroundFrame& known : background_.Next({frame.frame, frame.own}, frame.mask))
      done.push_back(WithBackground(known));
    return done;
  }
  std::vector<FrameOnWay> Rest() override {
    std::vector<FrameOnWay> done;
    while (const auto known = background_.Rest()) done.push_back(WithBackground(*known));
    return done;
  }

 private:
  FrameOnWay WithBackground(const BackgroundFrame& known) {
    FrameOnWay frame = waiting_.Take();
    frame.background = known.frame;
    return frame;
  }

  Background background_;
  const StillScene& scene_;
  Waiting waiting_;
};

// What moves laid into the background; without it the background is the result.
class Blend : public Stage {
 public:
  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    frame.frame = frame.mask.empty() ? frame.background : Blended(frame.frame, frame.background, frame.mask);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }
};

class Sharpen : public Stage {
 public:
  explicit Sharpen(Sharpener& sharpener) : sharpener_(sharpener) {}

  std::vector<FrameOnWay> Next(FrameOnWay frame) override {
    frame.blended = frame.frame;
    frame.frame = sharpener_.Next(frame.frame);
    return {frame};
  }
  std::vector<FrameOnWay> Rest() override { return {}; }

 private:
  Sharpener& sharpener_;
};

}  // namespace

std::vector<NamedStage> StagesOf(const RestorePlan& plan, const VideoFacts& facts, Sharpener* sharpener) {
  std::vector<NamedStage> stages;
  const auto add = [&](const char* name, std::unique_ptr<Stage> stage) {
    stages.push_back({name, std::move(stage)});
  };
  if (plan.grey) add("one channel", std::make_unique<OneChannel>());
  if (plan.fill)
    add("stabilise", std::make_unique<Fill>(facts));
  else if (plan.stabilise)
    add("stabilise", std::make_unique<Move>(facts));
  add("keep", std::make_unique<Keep>());
  if (plan.segment) add("segment", std::make_unique<Segment>(facts.scene->segment));
  if (plan.stack) {
    const BackgroundParams params{.ahead = plan.ahead,
                                  .registered = plan.registered,
                                  .lucky = plan.lucky,
                                  .scene = facts.scene->reference};
    add("stack", std::make_unique<Stack>(params, facts.scene->segment.scene));
    add("blend", std::make_unique<Blend>());
  }
  const bool cut = plan.area.size() != plan.size;
  if (cut) add("cut", std::make_unique<Cut>(plan.area - plan.picture.tl()));
  if (plan.sharpen) add("sharpen", std::make_unique<Sharpen>(*sharpener));
  if (!cut && plan.picture.size() != plan.size)
    add("put back", std::make_unique<PutBack>(facts.changing.first, plan.picture));
  return stages;
}

}  // namespace shimmer::restore
