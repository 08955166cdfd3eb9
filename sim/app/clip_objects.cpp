#include "sim/app/clip_objects.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "sim/colour.h"
#include "sim/size_text.h"
#include "sim/text.h"

namespace shimmer::app {
namespace {

constexpr const char* kText = "text";

using sim::SizeText;

cv::Mat AsFloat(const cv::Mat& samples) {
  return samples.depth() == CV_32F ? samples : dataset::FromSamples(samples);
}

cv::Mat AsRgb(const cv::Mat& pixels) {
  if (pixels.channels() == 3) return pixels;
  cv::Mat rgb;
  cv::merge(std::vector{pixels, pixels, pixels}, rgb);
  return rgb;
}

cv::Mat FirstChannel(const cv::Mat& pixels) {
  if (pixels.channels() == 1) return pixels;
  cv::Mat first;
  cv::extractChannel(pixels, first, 0);
  return first;
}

// RGB in [0, 1] as stored: hue, saturation and value of Smith 1978.
cv::Vec3f ColourOf(const ObjectParams& object) {
  const auto channel = [&](double offset) {
    const double sixth = std::fmod(offset + 6 * object.hue, 6.0);
    const double pure = std::clamp(std::min(sixth, 4 - sixth), 0.0, 1.0);
    return static_cast<float>(object.brightness * (1 - object.saturation * pure));
  };
  return {channel(5), channel(3), channel(1)};
}

sim::Shape ShapeNamed(const std::string& name) {
  const auto found = std::ranges::find(sim::kShapeNames, name);
  if (found == sim::kShapeNames.end()) throw std::logic_error("no shape is called " + name);
  return static_cast<sim::Shape>(found - sim::kShapeNames.begin());
}

// Colours, not multiplied by alpha, to the clip's light; then multiplied.
cv::Mat Premultiplied(cv::Mat rgb, const cv::Mat& alpha, bool stored, bool linear_light) {
  if (stored == linear_light) rgb = linear_light ? sim::DecodeSrgb(rgb) : sim::EncodeSrgb(rgb);
  cv::Mat rgba(rgb.size(), CV_32FC4);
  for (int y = 0; y < rgb.rows; ++y)
    for (int x = 0; x < rgb.cols; ++x) {
      const float a = alpha.at<float>(y, x);
      const auto& colour = rgb.at<cv::Vec3f>(y, x);
      cv::Vec4f& out = rgba.at<cv::Vec4f>(y, x);
      for (int c = 0; c < 3; ++c) out[c] = std::clamp(colour[c], 0.0f, 1.0f) * a;
      out[3] = a;
    }
  return rgba;
}

// One object on its way.
class ObjectMaker {
 public:
  ObjectMaker(const Job& job, const Config& config, sim::ClipKey key, const std::atomic<bool>& stop,
              size_t index)
      : job_(job),
        config_(config),
        object_(config.objects[index]),
        sources_(job.object_sources[index]),
        path_("objects." + std::to_string(index)),
        linear_light_(config.colour == sim::Colour::kLinear),
        key_(key),
        stop_(stop) {
    record_["object"] = index;
  }

  sim::PlacedObject Make() {
    sim::Look look = LookOf();
    try {
      return {sim::MovingObject(std::move(look), object_.motion, config_.size, config_.frames,
                                object_.height_px, object_.shutter),
              object_.distance};
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(path_ + ".motion: " + error.what());
    }
  }

  Json record_ = Json::object();

 private:
  sim::Look LookOf() {
    cv::Vec3f colour = ColourOf(object_);
    if (linear_light_) sim::DecodeSrgbRow({colour.val, 3});
    if (object_.drawn == kText) {
      try {
        return std::make_shared<const sim::Cutout>(sim::TextCutout(object_.text, colour));
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error(path_ + "." + error.what());
      }
    }
    if (!object_.drawn.empty()) return sim::DrawnLook{ShapeNamed(object_.drawn), colour};
    item_ = static_cast<size_t>(
        sim::DrawInteger(key_, path_ + ".item", 0, static_cast<int64_t>(sources_.items().size()) - 1));
    record_.update(sources_.Record(item_));
    return sources_.still() ? CutoutLook() : VideoLook();
  }

  sim::Look CutoutLook() const {
    const std::filesystem::path& file = sources_.items()[item_];
    return job_.cutouts->Get(file.native(), [&] {  // one job's are all of the same light
      const dataset::CutoutPicture picture = dataset::ReadCutout(file);
      return std::make_shared<const sim::Cutout>(
          Premultiplied(picture.rgb, picture.alpha, !picture.linear, linear_light_));
    });
  }

  sim::Look VideoLook() {
    const std::shared_ptr<dataset::FrameReader> frames = sources_.Open(item_, *job_.pictures, stop_),
                                                masks = sources_.OpenMasks(item_, *job_.pictures, stop_);
    const std::filesystem::path file = sources_.items()[item_], masks_file = sources_.masks()[item_];
    const int64_t spare = frames->count() - config_.frames;
    if (spare < 0)
      throw std::runtime_error(path_ + ": " + file.string() + " has " + std::to_string(frames->count()) +
                               " frames, must have at least " + std::to_string(config_.frames) + " (frames)");
    const int64_t start = sim::DrawInteger(key_, path_ + ".start", 0, spare);
    record_["start"] = start;
    // One frame is asked for again and again: for each snapshot while the shutter is open, and for its flow.
    return [=, linear_light = linear_light_, path = path_, last = int64_t{-1},
            shown = std::shared_ptr<const sim::Cutout>()](int64_t k) mutable {
      if (k == last) return shown;
      const dataset::Picture frame = frames->Read(start + k), mask = masks->Read(start + k);
      if (mask.pixels.size() != frame.pixels.size())
        throw std::runtime_error(path + ".masks: " + masks_file.string() + ": frame " +
                                 std::to_string(start + k) + " is " + SizeText(mask.pixels.size()) +
                                 " px, must be " + SizeText(frame.pixels.size()) + " as its frame");
      shown = std::make_shared<const sim::Cutout>(Premultiplied(
          AsRgb(AsFloat(frame.pixels)), FirstChannel(AsFloat(mask.pixels)), !frame.linear, linear_light));
      last = k;
      return shown;
    };
  }

  const Job& job_;
  const Config& config_;
  const ObjectParams& object_;
  const SourceList& sources_;
  std::string path_;
  bool linear_light_;
  sim::ClipKey key_;
  const std::atomic<bool>& stop_;
  size_t item_ = 0;
};

}  // namespace

ClipObjects ObjectsOf(const Job& job, const Config& config, sim::ClipKey key, const std::atomic<bool>& stop) {
  ClipObjects objects;
  for (size_t i = 0; i < config.objects.size(); ++i) {
    if (!config.objects[i].present) continue;
    ObjectMaker maker(job, config, key, stop, i);
    objects.placed.push_back(maker.Make());
    objects.record.push_back(std::move(maker.record_));
  }
  return objects;
}

}  // namespace shimmer::app
