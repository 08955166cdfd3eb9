// What moves by itself in a video through turbulence: a mask a frame.
//
// First a look at places of the video, evenly spread over it (SegmentSurvey): from it come the neighbours and
// the threshold of the averaged flow (aof.h) and the still scene (still_scene.h). Then frames one after the
// other (Segmenter). All at HalvedIfLarge's size; masks are enlarged.
#pragma once

#include <deque>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/aof.h"
#include "restore/still_scene.h"

namespace shimmer::restore {

enum class SegmentMethod {
  kAof,    // the paper's: what has a large averaged flow
  kFused,  // what lies outside of the still scene by more than turbulence explains
};

struct SegmentSettings {
  SegmentMethod method;
  AofSettings aof;
  double typical_speed_px = 0;  // a frame, of the reduced frame: the median of Motion::speed
  StillScene scene;             // of kFused
  cv::Mat near_movers;          // of kFused: CV_8UC1, 0 far from all that the flow saw move
  FlowMaker flow;               // by which aof was settled; of kAof
};

// Where to look in a video of so many frames: evenly spread, at most 32 of them, in order.
std::vector<int> SurveyPlaces(int frames, int most = 32);

class SegmentSurvey {
 public:
  explicit SegmentSurvey(SegmentMethod method, FlowMaker flow = DisFlows());

  // Frames as levels.h takes them, all of one size and type. Throws std::invalid_argument. Memory: a float
  // frame of HalvedIfLarge's size a place, and 11 bytes a px.
  // number: the frame's, in the video.
  void Add(const Place& place, int64_t number);
  // After the last; throws std::invalid_argument if there was none.
  SegmentSettings Settings() const;

 private:
  SegmentMethod method_;
  FlowMaker maker_;
  std::unique_ptr<DenseFlow> flow_;
  AofChoice choice_;
  std::vector<SceneSample> samples_;
  int64_t first_ = 0, last_ = 0;
  std::vector<cv::Mat> speeds_;  // of the samples, CV_16FC1
};

// What of one frame alone lies outside of the still scene: CV_8UC1 of its size, 255 or 0. Empty where there
// is no scene (kAof). Rougher than a Segmenter's masks, which see the neighbours too.
cv::Mat MovingAt(const SegmentSettings& settings, const SteadyFrame& frame);

// Frames one after the other, each mask given out once kReach later frames are known (kAof) or one (kFused).
// Memory: those frames and the settings.
class Segmenter {
 public:
  explicit Segmenter(SegmentSettings settings);

  // The mask of an earlier frame, if one is ready: CV_8UC1 of the frame's size, 0 still, 255 moving, between
  // them unsure (128 and more: rather moving). 0 where the frame is filled. Throws std::invalid_argument for
  // a frame of another size or type than the first of the survey.
  std::optional<cv::Mat> Next(const SteadyFrame& frame);

  // After the last frame: the masks still to come, in order.
  std::optional<cv::Mat> Rest();

 private:
  cv::Mat MaskAt(int i);

  SegmentSettings settings_;
  std::unique_ptr<DenseFlow> flow_;  // kAof
  int ahead_, next_ = 0;             // next_: of frames_, whose mask is given out next
  std::deque<SteadyFrame> frames_;   // kAof: whole; kFused: own alone
  std::deque<cv::Mat> distances_;    // kFused
  std::deque<cv::Mat> objects_;      // kFused
};

}  // namespace shimmer::restore
