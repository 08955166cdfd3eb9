#include "sim/camera.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "noise/hash.h"
#include "noise/portable_math.h"
#include "sim/unit_vector.h"

namespace shimmer::sim {
namespace {

// Normally distributed along both axes.
class NormalPoints {
 public:
  explicit NormalPoints(ClipKey key) : stream_(noise::HashPath(key.seed, key.clip, "camera.shake")) {}

  // Box and Muller 1958: two independent numbers at once.
  cv::Point2d Next() {
    const double u = noise::UnitFromBits(stream_.Next()), v = noise::UnitFromBits(stream_.Next());
    return UnitVector(v) * std::sqrt(-2 * noise::Log(1 - u));
  }

 private:
  noise::HashStream stream_;
};

// A place on a line that is folded at -bound and bound.
double Folded(double place, double bound) {
  if (bound <= 0) return 0;
  const double period = 4 * bound;
  double from_end = std::abs(place - bound);
  from_end -= std::floor(from_end / period) * period;
  return bound - std::min(from_end, period - from_end);
}

cv::Point2d Folded(cv::Point2d place, double bound) {
  return {Folded(place.x, bound), Folded(place.y, bound)};
}

std::vector<cv::Point2d> Walk(const CameraParams& camera, ClipKey key, int64_t frames) {
  NormalPoints steps(key);
  std::vector<cv::Point2d> path(1);
  for (int64_t k = 1; k < frames; ++k)
    path.push_back(Folded(path.back() + steps.Next() * camera.amplitude_px, camera.bound_px));
  return path;
}

// Begins anywhere in the process, and is seen from there.
std::vector<cv::Point2d> Drift(const CameraParams& camera, ClipKey key, int64_t frames) {
  const double kept = noise::Exp(-1 / camera.correlation_frames),
               fresh = std::sqrt(1 - kept * kept) * camera.amplitude_px;
  NormalPoints numbers(key);
  const cv::Point2d first = numbers.Next() * camera.amplitude_px;
  cv::Point2d place = first;
  std::vector<cv::Point2d> path(1);
  for (int64_t k = 1; k < frames; ++k) {
    place = place * kept + numbers.Next() * fresh;
    path.push_back(Folded(place - first, camera.bound_px));
  }
  return path;
}

std::vector<cv::Point2d> Vibration(const CameraParams& camera, ClipKey key, int64_t frames) {
  const double phase = noise::UnitFromBits(noise::HashPath(key.seed, key.clip, "camera.shake"));
  const cv::Point2d along = UnitVector(camera.direction_deg / 360) * camera.amplitude_px;
  std::vector<cv::Point2d> path(1);
  for (int64_t k = 1; k < frames; ++k) {
    const double now = phase + camera.frequency * static_cast<double>(k);
    path.push_back(along * (UnitVector(now).y - UnitVector(phase).y));
  }
  return path;
}

std::vector<cv::Point2d> Listed(const CameraParams& camera, int64_t frames) {
  if (static_cast<int64_t>(camera.shifts.size()) < frames)
    throw std::invalid_argument("camera.shifts: has " + std::to_string(camera.shifts.size()) +
                                " shifts, must have one for each of the " + std::to_string(frames) +
                                " frames");
  std::vector<cv::Point2d> path(camera.shifts.begin(), camera.shifts.begin() + frames);
  const cv::Point2d first = path.front();
  for (cv::Point2d& shift : path) shift -= first;
  return path;
}

// A direction's cosine of 1e-16 is none.
int UpToWhole(double px) { return static_cast<int>(std::ceil(px - 1e-9)); }

}  // namespace

cv::Size ShakeReach(const CameraParams& camera) {
  switch (camera.shake) {
    case Shake::kNone:
      return {};
    case Shake::kWalk:
    case Shake::kDrift: {
      const int most = camera.amplitude_px > 0 ? UpToWhole(camera.bound_px) : 0;
      return {most, most};
    }
    case Shake::kVibration: {  // from one end of the sine to the other
      const cv::Point2d most = UnitVector(camera.direction_deg / 360) * (2 * camera.amplitude_px);
      return {UpToWhole(std::abs(most.x)), UpToWhole(std::abs(most.y))};
    }
    case Shake::kList: {
      cv::Size most;
      for (const cv::Point2d& shift : camera.shifts) {
        const cv::Point2d from_first = shift - camera.shifts.front();
        most.width = std::max(most.width, UpToWhole(std::abs(from_first.x)));
        most.height = std::max(most.height, UpToWhole(std::abs(from_first.y)));
      }
      return most;
    }
  }
  throw std::logic_error("ShakeReach: no such shake");
}

std::vector<cv::Point2d> ShakePath(const CameraParams& camera, ClipKey key, int64_t frames) {
  switch (camera.shake) {
    case Shake::kNone:
      return std::vector<cv::Point2d>(static_cast<size_t>(frames));
    case Shake::kWalk:
      return Walk(camera, key, frames);
    case Shake::kDrift:
      return Drift(camera, key, frames);
    case Shake::kVibration:
      return Vibration(camera, key, frames);
    case Shake::kList:
      return Listed(camera, frames);
  }
  throw std::logic_error("ShakePath: no such shake");
}

}  // namespace shimmer::sim
