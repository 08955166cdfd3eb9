#include "restore/segment.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "restore/levels.h"
#include "restore/mask_cleaning.h"
#include "restore/otsu.h"

namespace shimmer::restore {
namespace {

constexpr int kMoverGuard_px = 2;  // around what the flow sees to move
// What moves on is faster than what is typical of the video, which turbulence makes: by so much, and
// somewhere by so much. Below kLeastSpeed_px a frame nothing is.
constexpr double kMoving = 4, kSurelyMoving = 7, kLeastSpeed_px = 0.03;
constexpr double kMostSpeed_px = 16;
// What is this far from all that the flow ever saw move may be too fast for it. It has to be surer, by this
// factor of the threshold, in so many pixels: less is the air's doing, such as glints on fine texture.
constexpr int kMoverReach_px = 16;
constexpr double kUnseen = 2;
constexpr int kLeastUnseen_px = 80;
// Of the frame's longer side: where all that passes goes that far during the video, no one thing hides a
// pixel for most of it.
constexpr double kFarTravel = 0.18;
constexpr int kRim_px = 4;
constexpr double kRimPart = 0.4;
constexpr double kUnrestSigma_px = 2;
constexpr int kLeastObject_px = 20, kStep_px = 3;  // of what moves: its area, and what it does in a frame
constexpr double kSoftest = 0.5;                   // of the threshold: below it is surely still
constexpr int kSoftRim_px = 2;

cv::Mat LevelFrame(const cv::Mat& frame) {
  const cv::Mat small = HalvedIfLarge(frame);
  cv::Mat levels;
  small.convertTo(levels, CV_32F, 255 / WhiteOf(frame.depth()));
  return levels;
}

void RequireSteady(const SteadyFrame& frame) {
  RequireFrame(frame.frame, "frame");
  if (frame.own.type() != CV_8UC1 || frame.own.size() != frame.frame.size())
    throw std::invalid_argument("own must be CV_8UC1 of the frame's size");
}

// How much the frame differs from those 4 before and after it, or from the nearest there are.
cv::Mat UnrestOf(const Place& place, const cv::Mat& frame) {
  cv::Mat most = cv::Mat::zeros(frame.size(), CV_32FC1);
  bool found = false;
  for (const int n : {2, 3, 0, 1, 4, 5}) {
    const cv::Mat& other = place.neighbours[static_cast<size_t>(n)].frame;
    if (other.empty() || (found && n != 3)) continue;
    const cv::Mat apart = MostOfChannels(cv::abs(frame - LevelFrame(other)));
    most = cv::max(most, apart), found = true;
  }
  cv::GaussianBlur(most, most, {0, 0}, kUnrestSigma_px, 0, cv::BORDER_REPLICATE);
  return most;
}

// The median of what frames' own px move at.
double TypicalSpeed(const std::vector<cv::Mat>& speeds, const std::vector<SceneSample>& samples) {
  PooledHistogram pooled(kMostSpeed_px, 4096);
  for (size_t k = 0; k < speeds.size(); ++k) {
    cv::Mat speed;
    speeds[k].convertTo(speed, CV_32F);
    pooled.Add(speed, samples[k].own);
  }
  return pooled.Quantile(0.5);
}

// How far the frame's own px lie outside of the scene, in thresholds.
cv::Mat OutsideOf(const StillScene& scene, const cv::Mat& level, const cv::Mat& own) {
  cv::Mat outside = DistanceTo(scene.interval, level) / scene.threshold;
  outside.setTo(0, OwnAtSize(own, level.size()) == 0);
  return outside;
}

// Objects are blurred: they end where that part of what is seen of them near by is left.
cv::Mat ObjectsOf(const SegmentSettings& settings, const cv::Mat& level, const cv::Mat& outside) {
  const StillScene& scene = settings.scene;
  cv::Mat surely = scene.threshold.clone();
  cv::Mat(surely * kUnseen).copyTo(surely, settings.near_movers == 0);
  const cv::Mat sure = DistanceTo(scene.wide, level) > surely;
  cv::Mat most;
  cv::dilate(outside, most, Disc(kRim_px));
  const cv::Mat objects =
      MovingObjects(outside / cv::max(cv::Mat(kRimPart * most), 1.0), 1, sure, kLeastObject_px);
  return Holding(objects, settings.near_movers, 1) | Holding(objects, sure, kLeastUnseen_px);
}

}  // namespace

std::vector<int> SurveyPlaces(int frames, int most) {
  if (frames < 1 || most < 1) throw std::invalid_argument("SurveyPlaces: frames and most must be at least 1");
  std::vector<int> places;
  const int count = std::min(frames, most);
  for (int i = 0; i < count; ++i)
    places.push_back(
        count == 1 ? frames / 2
                   : static_cast<int>(std::lround(static_cast<double>(i) * (frames - 1) / (count - 1))));
  return places;
}

SegmentSurvey::SegmentSurvey(SegmentMethod method, FlowMaker flow)
    : method_(method), maker_(std::move(flow)), flow_(maker_()) {}

void SegmentSurvey::Add(const Place& place, int64_t number) {
  RequireSteady(place.current);
  if (place.neighbours.size() != kMostNeighbours)
    throw std::invalid_argument("place must have 6 neighbours, empty where there is none");
  for (const SteadyFrame& neighbour : place.neighbours) {
    if (neighbour.frame.empty()) continue;
    RequireSteady(neighbour);
    if (neighbour.frame.size() != place.current.frame.size() ||
        neighbour.frame.type() != place.current.frame.type())
      throw std::invalid_argument("neighbour is of another size or type than the frame");
  }
  const cv::Mat frame = LevelFrame(place.current.frame), own = OwnAtSize(place.current.own, frame.size());
  if (!samples_.empty() &&
      (samples_[0].frame.size() != frame.size() || samples_[0].frame.type() != frame.type()))
    throw std::invalid_argument("place is of another size or type than the first");
  const Motion motion = MotionOf(*flow_, place);
  choice_.Add(motion.aof, own);
  if (samples_.empty()) first_ = number;
  last_ = number;
  motion.speed.convertTo(speeds_.emplace_back(), CV_16F);
  samples_.push_back({frame, own, {}, UnrestOf(place, frame)});
}

SegmentSettings SegmentSurvey::Settings() const {
  if (samples_.empty()) throw std::invalid_argument("survey without a place");
  SegmentSettings settings{method_, choice_.Settings(), TypicalSpeed(speeds_, samples_), {}, {}, maker_};
  if (method_ == SegmentMethod::kAof) return settings;
  std::vector<SceneSample> samples = samples_;
  const double typical = std::max(settings.typical_speed_px, kLeastSpeed_px);
  cv::Mat unvisited(samples[0].own.size(), CV_8UC1, cv::Scalar(255));
  cv::Mat travel_px = cv::Mat::zeros(samples[0].own.size(), CV_32FC1);
  for (size_t k = 0; k < samples.size(); ++k) {
    cv::Mat speed;
    speeds_[k].convertTo(speed, CV_32F);
    cv::dilate(MovingObjects(speed, kMoving * typical, speed > kSurelyMoving * typical, kLeastObject_px),
               samples[k].movers, Disc(kMoverGuard_px));
    unvisited.setTo(0, samples[k].movers);
    travel_px += speed * (static_cast<double>(last_ - first_) / static_cast<double>(samples.size()));
  }
  const int side_px = std::max(travel_px.cols, travel_px.rows);
  settings.scene = FindStillScene(samples, travel_px > kFarTravel * side_px);
  cv::dilate(~unvisited, settings.near_movers, Disc(kMoverReach_px));
  return settings;
}

cv::Mat MovingAt(const SegmentSettings& settings, const SteadyFrame& frame) {
  if (settings.method == SegmentMethod::kAof) return {};
  const cv::Mat level = LevelFrame(frame.frame);
  cv::Mat moving;
  cv::resize(ObjectsOf(settings, level, OutsideOf(settings.scene, level, frame.own)), moving,
             frame.frame.size(), 0, 0, cv::INTER_NEAREST);
  return moving;
}

Segmenter::Segmenter(SegmentSettings settings)
    : settings_(std::move(settings)),
      flow_(settings_.method == SegmentMethod::kAof ? settings_.flow() : nullptr),
      ahead_(settings_.method == SegmentMethod::kAof ? kReach : 1) {}

std::optional<cv::Mat> Segmenter::Next(const SteadyFrame& frame) {
  RequireSteady(frame);
  if (!frames_.empty() && frames_.back().own.size() != frame.own.size())
    throw std::invalid_argument("frame is of another size than the first");
  if (settings_.method == SegmentMethod::kFused) {
    const cv::Mat level = LevelFrame(frame.frame);
    if (level.size() != settings_.scene.picture.size() || level.type() != settings_.scene.picture.type())
      throw std::invalid_argument("frame is of another size or type than those of the survey");
    distances_.push_back(OutsideOf(settings_.scene, level, frame.own));
    objects_.push_back(ObjectsOf(settings_, level, distances_.back()));
    frames_.push_back({{}, frame.own});
  } else {
    if (!frames_.empty() && frames_.back().frame.type() != frame.frame.type())
      throw std::invalid_argument("frame is of another type than the first");
    frames_.push_back(frame);
  }
  if (static_cast<int>(frames_.size()) - next_ <= ahead_) return {};
  return Rest();
}

std::optional<cv::Mat> Segmenter::Rest() {
  if (next_ >= static_cast<int>(frames_.size())) return {};
  const cv::Mat mask = MaskAt(next_);
  if (next_ < ahead_) {
    ++next_;
  } else {
    frames_.pop_front();
    if (!distances_.empty()) distances_.pop_front(), objects_.pop_front();
  }
  return mask;
}

cv::Mat Segmenter::MaskAt(int i) {
  const SteadyFrame& frame = frames_[static_cast<size_t>(i)];
  const int count = static_cast<int>(frames_.size());
  cv::Mat mask;
  if (settings_.method == SegmentMethod::kAof) {
    const Place place = PlaceAt(
        i, [&](int64_t k) { return k >= 0 && k < count ? &frames_[static_cast<size_t>(k)] : nullptr; });
    const cv::Mat aof = AofOf(*flow_, place, settings_.aof.neighbours).back();
    const double threshold = settings_.aof.threshold_px;
    mask = threshold > 0 ? cv::Mat(aof > threshold) : cv::Mat::zeros(aof.size(), CV_8UC1);
  } else {
    const auto objects = [&](int k) {
      return k < 0 || k >= count ? cv::Mat() : objects_[static_cast<size_t>(k)];
    };
    const cv::Mat kept = Persistent(objects(i), objects(i - 1), objects(i + 1), kStep_px);
    cv::Mat soft, near;
    distances_[static_cast<size_t>(i)].convertTo(soft, CV_8U, 127 / (1 - kSoftest),
                                                 128 - 127 / (1 - kSoftest));
    cv::dilate(kept, near, Disc(kSoftRim_px));
    mask = cv::Mat::zeros(soft.size(), CV_8UC1);
    cv::Mat(cv::min(soft, 127)).copyTo(mask, near);
    cv::Mat(cv::max(soft, 128)).copyTo(mask, kept);
  }
  if (mask.size() != frame.own.size()) cv::resize(mask, mask, frame.own.size(), 0, 0, cv::INTER_LINEAR);
  mask.setTo(0, frame.own == 0);
  return mask;
}

}  // namespace shimmer::restore
