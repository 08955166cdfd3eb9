#include "sim/moving_scene.h"

#include <cmath>

namespace shimmer::sim {

MovingScene::MovingScene(std::vector<PlacedObject> objects, const ClipPlan& plan, Rounding rounding)
    : objects_(std::move(objects)),
      area_(plan.Area()),
      size_(plan.shape.size),
      linear_light_(plan.linear_light),
      rounding_(std::move(rounding)) {}

MovingScene::Frame::Frame(const MovingScene& scene, int64_t k) : scene_(&scene), k_(k) {
  for (const PlacedObject& placed : scene.objects_) layers_.push_back(placed.object.At(k, scene.area_));
  flat_ = Flattened(layers_);
}

std::vector<cv::Rect> MovingScene::Frame::Over(cv::Mat& samples, cv::Point origin) const {
  std::vector<cv::Rect> areas;
  for (const Layer& layer : flat_) {
    Composite(layer, origin, scene_->linear_light_, samples);
    const cv::Rect seen = (layer.area - origin) & cv::Rect({}, samples.size());
    if (seen.empty()) continue;
    cv::Mat composed = samples(seen);
    if (scene_->rounding_) scene_->rounding_(composed);
    areas.push_back(seen);
  }
  return areas;
}

cv::Mat MovingScene::Frame::Mask() const {
  cv::Mat mask = cv::Mat::zeros(scene_->size_, CV_32FC1);
  for (const Layer& layer : flat_) AddCoverage(layer, {}, mask);
  return mask;
}

cv::Mat MovingScene::Frame::Flow() const {
  cv::Mat flow = cv::Mat::zeros(scene_->size_, CV_32FC2);
  for (size_t i = 0; i < layers_.size(); ++i) {
    const cv::Rect seen = layers_[i].area & cv::Rect({}, scene_->size_);
    if (seen.empty()) continue;
    const cv::Mat own = scene_->objects_[i].object.FlowAt(k_, seen);
    for (int y = 0; y < seen.height; ++y)
      for (int x = 0; x < seen.width; ++x)
        if (const auto& way = own.at<cv::Vec2f>(y, x); !std::isnan(way[0]))
          flow.at<cv::Vec2f>(seen.y + y, seen.x + x) = way;
  }
  return flow;
}

cv::Mat MovingScene::Frame::Strength(cv::Rect area, cv::Point2d shake_px) const {
  // At the whole px around p - s, and between them.
  const cv::Point whole(cvFloor(-shake_px.x), cvFloor(-shake_px.y));
  const auto across = static_cast<float>(-shake_px.x - whole.x),
             down = static_cast<float>(-shake_px.y - whole.y);
  const cv::Rect steady(area.tl() + whole, cv::Size(area.width + 1, area.height + 1));
  cv::Mat factor(steady.size(), CV_32FC1, cv::Scalar::all(1));
  bool any = false;
  for (size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    const cv::Rect seen = layer.area & steady;
    const auto distance = static_cast<float>(scene_->objects_[i].distance);
    for (int y = seen.y; y < seen.br().y; ++y)
      for (int x = seen.x; x < seen.br().x; ++x) {
        const float alpha = layer.rgba.at<cv::Vec4f>(y - layer.area.y, x - layer.area.x)[3];
        float& there = factor.at<float>(y - steady.y, x - steady.x);
        there += alpha * (distance - there);
        any = true;
      }
  }
  cv::Mat between = factor(cv::Rect({}, area.size()));
  if (!any || (across == 0 && down == 0)) return between;
  between = cv::Mat(area.size(), CV_32FC1);
  for (int y = 0; y < area.height; ++y) {
    const float *upper = factor.ptr<float>(y), *lower = factor.ptr<float>(y + 1);
    float* row = between.ptr<float>(y);
    for (int x = 0; x < area.width; ++x) {
      const float above = upper[x] + across * (upper[x + 1] - upper[x]),
                  below = lower[x] + across * (lower[x + 1] - lower[x]);
      row[x] = above + down * (below - above);
    }
  }
  return between;
}

ComposedFrames::ComposedFrames(const cv::Mat& background, cv::Point origin, const ClipPlan& plan)
    : background_(background), samples_(background.clone()), frame_(samples_, origin, plan) {}

const CleanFrame& ComposedFrames::With(const MovingScene::Frame& objects) {
  for (const cv::Rect& area : covered_) background_(area).copyTo(samples_(area));
  std::vector<cv::Rect> changed = std::move(covered_);
  covered_ = objects.Over(samples_, frame_.origin);
  changed.insert(changed.end(), covered_.begin(), covered_.end());
  for (const cv::Rect& area : changed) frame_.Derive(area);
  return frame_;
}

}  // namespace shimmer::sim
