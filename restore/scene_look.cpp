#include "restore/scene_look.h"

#include <map>
#include <optional>
#include <set>

#include "restore/luck.h"
#include "restore/scene_reference.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

// The frames that places need, in order.
std::set<int64_t> NeededFor(const std::vector<int>& places, int64_t frames) {
  std::set<int64_t> needed(places.begin(), places.end());
  for (const int place : places)
    for (int n = 0; n < kMostNeighbours; ++n)
      if (const int64_t k = place + NeighbourAt(n); k >= 0 && k < frames) needed.insert(k);
  return needed;
}

class SteadyReader {
 public:
  SteadyReader(Frames& video, std::span<const FrameShift> shifts, bool grey,
               const std::function<void()>& step)
      : video_(video), shifts_(shifts), grey_(grey), step_(step) {}

  SteadyFrame Read(int64_t k) {
    cv::Mat frame = video_.Read(k);
    step_();
    if (grey_ && frame.channels() > 1) cv::extractChannel(cv::Mat(frame), frame, 0);
    SteadyFrame steady{frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))};
    if (shifts_.empty()) return steady;
    const cv::Point2d shift_px = shifts_[static_cast<size_t>(k)].px;
    steady.frame = Translated(frame, shift_px);
    steady.own.setTo(0);
    steady.own(SeenArea(frame.size(), shift_px)).setTo(255);
    return steady;
  }

 private:
  Frames& video_;
  std::span<const FrameShift> shifts_;
  bool grey_;
  const std::function<void()>& step_;
};

// Each place once all of its frames are there; what no later place needs is let go.
SegmentSettings Survey(SteadyReader& reader, const std::vector<int>& places, int64_t frames,
                       SegmentMethod method, const FlowMaker& flow) {
  SegmentSurvey survey(method, flow);
  std::map<int64_t, SteadyFrame> there;
  auto place = places.begin();
  const auto add_whole = [&](int64_t read_up_to) {
    for (; place != places.end() && (*place + kReach <= read_up_to || read_up_to == frames - 1); ++place) {
      survey.Add(PlaceAt(*place,
                         [&](int64_t k) {
                           const auto frame = there.find(k);
                           return frame == there.end() ? nullptr : &frame->second;
                         }),
                 *place);
    }
    there.erase(there.begin(), there.lower_bound(place == places.end() ? frames : *place - kReach));
  };
  for (const int64_t k : NeededFor(places, frames)) {
    add_whole(k - 1);
    there.emplace(k, reader.Read(k));
  }
  add_whole(frames - 1);
  return survey.Settings();
}

}  // namespace

int64_t ReadsOfLook(int64_t frames) {
  const std::vector<int> places = SurveyPlaces(static_cast<int>(frames));
  return std::ssize(NeededFor(places, frames)) + std::ssize(places);
}

SceneFacts LookAtScene(Frames& video, std::span<const FrameShift> shifts, bool grey, SegmentMethod method,
                       const FlowMaker& flow, Register registered, const std::function<void()>& step) {
  const int64_t frames = video.count();
  const std::vector<int> places = SurveyPlaces(static_cast<int>(frames));
  SteadyReader reader(video, shifts, grey, step);
  SceneFacts facts{.segment = Survey(reader, places, frames, method, flow)};
  StrengthEstimate strength;
  LuckSpread luck;
  std::optional<SceneReferenceMean> reference;
  if (method == SegmentMethod::kFused && registered != Register::kOff) reference.emplace();
  for (const int place : places) {
    const SteadyFrame steady = reader.Read(place);
    const cv::Mat moving = MovingAt(facts.segment, steady);  // empty: not known of a frame alone
    if (!moving.empty()) facts.moving_share += cv::mean(moving)[0] / 255 / static_cast<double>(places.size());
    const cv::Mat hidden = moving.empty() ? cv::Mat(~steady.own) : cv::Mat(moving | ~steady.own);
    strength.Add(steady.frame, hidden);
    luck.Add(steady.frame, hidden);
    if (reference) reference->Add({steady.frame, ~hidden});
  }
  if (method == SegmentMethod::kAof) facts.moving_share = facts.segment.aof.threshold_px > 0;
  facts.strength = strength.Result();
  facts.luck_octaves = luck.Octaves();
  if (reference && BackgroundFor(facts.strength, registered).registered)
    facts.reference = reference->Result();
  return facts;
}

}  // namespace shimmer::restore
