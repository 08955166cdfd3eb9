#include "sim/app/clean_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "sim/colour.h"
#include "sim/crop.h"
#include "sim/drawn/drawn.h"
#include "sim/size_text.h"

namespace shimmer::app {
namespace {

using sim::SizeText;

bool Holds(cv::Size outer, cv::Size inner) {
  return outer.width >= inner.width && outer.height >= inner.height;
}

}  // namespace

cv::Size Scaled(cv::Size size, double scale) {
  return {std::max(1, static_cast<int>(std::lround(size.width * scale))),
          std::max(1, static_cast<int>(std::lround(size.height * scale)))};
}

dataset::Encoding EncodingOf(const OutputParams& output) {
  return {.format = output.format == Format::kPng ? dataset::FileFormat::kPng : dataset::FileFormat::kExr,
          .bits = output.bits,
          .png_writer = output.png_writer == PngWriter::kIsal ? dataset::PngWriter::kIsal
                                                              : dataset::PngWriter::kOpenImageIo};
}

bool OutputIsLinear(const Config& config) {
  return config.colour == sim::Colour::kLinear && config.output.format == Format::kExr;
}

CleanFrames::CleanFrames(const SourceList& sources, dataset::PictureCache& pictures, const Config& config,
                         sim::ClipKey key, const std::atomic<bool>& stop)
    : sources_(sources), config_(config), key_(key), reach_px_(sim::ShakeReach(config.camera)) {
  flip_ = config.source.flip && sim::DrawUnit(key, "source.flip") < 0.5;
  record_["flip"] = flip_;
  if (sources.kind() == SourceKind::kDrawn) {
    record_["drawn"] = config.source.drawn;
    record_["scale"] = config.source.scale;
    variation_ = static_cast<uint64_t>(sim::DrawInteger(key, "source.variation", 0, INT64_MAX - 1));
    record_["variation"] = variation_;
    return;
  }
  item_ = static_cast<size_t>(
      sim::DrawInteger(key, "source.item", 0, static_cast<int64_t>(sources.items().size()) - 1));
  record_.update(sources.Record(item_));
  reader_ = sources.Open(item_, pictures, stop);
  if (const std::string remark = sources.Remark(item_); !remark.empty()) record_["remark"] = remark;
  if (still()) return;
  if (!sources.masks().empty()) masks_ = sources.OpenMasks(item_, pictures, stop);

  const int64_t needed = config.first_frame + config.frames, spare = reader_->count() - needed;
  if (spare < 0)
    throw std::runtime_error(sources.items()[item_].string() + ": has " + std::to_string(reader_->count()) +
                             " frames, must have at least " + std::to_string(needed) +
                             " (first_frame + frames)");
  if (config.source.start == Start::kRandom) start_ = sim::DrawInteger(key, "source.start", 0, spare);
  record_["start"] = start_;
}

bool CleanFrames::still() const { return sources_.still(); }

cv::Mat CleanFrames::Frame(int64_t t, int around_px) {
  if (still() && around_px == still_around_px_) return still_frame_;
  cv::Mat frame;
  if (reader_) {
    frame = Prepare(reader_->Read(still() ? 0 : start_ + t), around_px);
  } else {
    frame = Prepare({.pixels = sim::DrawScene(sim::DrawnSceneNamed(config_.source.drawn), config_.size,
                                              around_px, config_.source.scale, variation_)},
                    around_px);
  }
  if (still()) still_frame_ = frame, still_around_px_ = around_px;
  return frame;
}

cv::Mat CleanFrames::Mask(int64_t t) {
  if (!masks_) return {};
  const cv::Size size = reader_->Read(start_ + t).pixels.size();
  cv::Mat mask = masks_->Read(start_ + t).pixels;
  if (mask.size() != size)
    throw std::runtime_error("source.masks: " + sources_.masks()[item_].string() + ": frame " +
                             std::to_string(start_ + t) + " is " + SizeText(mask.size()) + " px, must be " +
                             SizeText(size) + " as its frame");
  if (mask.channels() > 1) cv::extractChannel(mask, mask, 0);
  mask = mask.depth() == CV_32F ? mask : dataset::FromSamples(mask);
  if (const double threshold = config_.source.mask_threshold; threshold > 0) {
    cv::Mat covered(mask.size(), CV_32FC1);
    for (int y = 0; y < mask.rows; ++y)
      for (int x = 0; x < mask.cols; ++x)
        covered.at<float>(y, x) = mask.at<float>(y, x) >= static_cast<float>(threshold) ? 1.0f : 0.0f;
    mask = covered;
  }
  const Place place = PlaceIn(size);
  mask = sim::ResizedCropWithHalo(mask, place.scaled, place.crop, 0);
  if (flip_) cv::flip(mask, mask, 1);
  return cv::max(cv::min(mask, 1), 0);  // a bicubic overshoots
}

cv::Mat CleanFrames::Prepare(const dataset::Picture& picture, int around_px) {
  cv::Mat pixels = picture.pixels;
  if (reader_) {  // drawn scenes are drawn at their size, surroundings and all
    const Place place = PlaceIn(pixels.size());
    pixels = sim::ResizedCropWithHalo(pixels, place.scaled, place.crop, around_px);
    record_["scale"] = place.scale;
    record_["crop"] = {place.crop.x, place.crop.y, place.crop.width, place.crop.height};
    if (picture.alpha_dropped) record_["alpha_dropped"] = true;
    if (picture.replaced > 0)
      record_["replaced_samples"] = record_.value("replaced_samples", int64_t{0}) + picture.replaced;
  }
  if (flip_) cv::flip(pixels, pixels, 1);
  if (config_.colour == sim::Colour::kLinear && picture.linear != OutputIsLinear(config_))
    pixels = picture.linear ? sim::EncodeSrgb(pixels) : sim::DecodeSrgb(pixels);
  const dataset::Encoding encoding = EncodingOf(config_.output);
  return encoding.format == dataset::FileFormat::kPng ? dataset::ToSamples(pixels, encoding)
                                                      : dataset::Quantise(pixels, encoding);
}

CleanFrames::Place CleanFrames::PlaceIn(cv::Size size) const {
  const double scale = FittingScale(size);
  const cv::Size scaled = Scaled(size, scale);
  return {scale, scaled, ChooseCrop(scaled)};
}

// The drawn scale, or the least larger one by which the crop fits: a set of photographs has all sizes, and
// one that is large enough as it is shall not fail because a small scale was drawn.
double CleanFrames::FittingScale(cv::Size size) const {
  double scale = config_.source.scale;
  const cv::Size needed = config_.size + reach_px_ * 2;
  if (Holds(Scaled(size, scale), needed)) return scale;
  if (Holds(size, needed) && scale < 1)
    return std::min(1.0, std::max(static_cast<double>(needed.width) / size.width,
                                  static_cast<double>(needed.height) / size.height));
  std::string text = sources_.items()[item_].string() + ": is " + SizeText(size) + " px" +
                     (scale == 1 ? "" : " (" + SizeText(Scaled(size, scale)) + " after source.scale)") +
                     ", smaller than the crop of " + SizeText(config_.size);
  if (needed != config_.size)
    text += " and the camera's shake around it, " + SizeText(needed) + " in all (camera.shake, its " +
            (config_.camera.shake == sim::Shake::kList        ? "shifts)"
             : config_.camera.shake == sim::Shake::kVibration ? "amplitude_px)"
                                                              : "bound_px)");
  throw std::runtime_error(text);
}

cv::Rect CleanFrames::ChooseCrop(cv::Size scaled) const {
  const cv::Size spare = scaled - config_.size - reach_px_ * 2;
  const cv::Point first(reach_px_.width, reach_px_.height);
  if (config_.source.crop == Crop::kCentre)
    return {first + cv::Point(spare.width / 2, spare.height / 2), config_.size};
  return {first + cv::Point(static_cast<int>(sim::DrawInteger(key_, "source.crop.x", 0, spare.width)),
                            static_cast<int>(sim::DrawInteger(key_, "source.crop.y", 0, spare.height))),
          config_.size};
}

}  // namespace shimmer::app
