// What moves in a clip: objects in front of a background, from the farthest to the nearest, and the truth
// about them. All in the steady frame, whose pixel (0, 0) is the crop's first (sim/camera.h).
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/clean_frame.h"
#include "sim/layer.h"
#include "sim/moving_object.h"

namespace shimmer::sim {

struct PlacedObject {
  MovingObject object;
  double distance = 1;  // factor on tilt and sigma where it is seen, [0, 1]
};

// Rounds samples to those that a file holds, in place.
using Rounding = std::function<void(cv::Mat& samples)>;

class MovingScene {
 public:
  // plan: the clip's; nothing is drawn that lies outside of its Area(). rounding: of what is composed, where
  // samples of its type may be none of a file's (half floats).
  MovingScene(std::vector<PlacedObject> objects, const ClipPlan& plan, Rounding rounding = {});

  // All that moves in frame k, counted from the clip's first.
  class Frame {
   public:
    // Over samples (of CleanFrame's types) whose pixel (0, 0) lies at origin, in stored or linear light as
    // the plan says. Gives the areas, in the samples' own pixels, outside of which nothing changed.
    std::vector<cv::Rect> Over(cv::Mat& samples, cv::Point origin) const;

    // Coverage by any object, CV_32FC1 in [0, 1].
    cv::Mat Mask() const;

    // To frame k + 1, px, of what is seen at each pixel: CV_32FC2, (0, 0) where no object covers half of it.
    cv::Mat Flow() const;

    // Factor on tilt and sigma of the pixels of an area of the frame as a camera of this shake sees it:
    // CV_32FC1; 1 + coverage (distance - 1), each object over those behind it.
    cv::Mat Strength(cv::Rect area, cv::Point2d shake_px) const;

   private:
    friend class MovingScene;
    Frame(const MovingScene& scene, int64_t k);
    const MovingScene* scene_;
    int64_t k_;
    std::vector<Layer> layers_;  // one an object
    std::vector<Layer> flat_;
  };
  Frame At(int64_t k) const { return {*this, k}; }

 private:
  std::vector<PlacedObject> objects_;
  cv::Rect area_;  // that may be seen
  cv::Size size_;  // the crop's
  bool linear_light_;
  Rounding rounding_;
};

// The clean frames of a clip with moving objects over a background that stands, prepared for rendering: from
// one to the next only what an object covers, or has covered, is composed again. The same bits as a frame
// composed and prepared alone.
class ComposedFrames {
 public:
  // background: CleanFrame's samples, its pixel (0, 0) at origin.
  ComposedFrames(const cv::Mat& background, cv::Point origin, const ClipPlan& plan);

  // Valid until the next call.
  const CleanFrame& With(const MovingScene::Frame& objects);

 private:
  cv::Mat background_;
  cv::Mat samples_;  // the background with the objects of the frame before
  CleanFrame frame_;
  std::vector<cv::Rect> covered_;
};

}  // namespace shimmer::sim
